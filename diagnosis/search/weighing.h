// Every cause weighed on the rows that are no outliers. Rows that are false, the noise and the
// moments of steps are known the better, the more is explained: all are found in turn.
#pragma once

#include <memory>
#include <string>

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/options.h"

namespace selfcal {

/// The evidence of the rows that are kept.
std::unique_ptr<EvidenceEvaluator> evidence_of(const LinearisedModel& linearised,
                                               const DataSet& data, const SearchRule& rule);

/// Why there are too few rows; empty where there are enough.
std::string lacking(const EvidenceEvaluator& evaluator);

struct Weighed {
  std::unique_ptr<EvidenceEvaluator> evaluator;  ///< of the rows that `linearised` keeps at the end
  Posterior posterior;
  std::string problem;  ///< why there is no posterior; empty where there is one
};

/// Until neither the false rows nor the noise change: `linearised` has them then.
Weighed weigh(LinearisedModel& linearised, const DataSet& data, const DiagnosisOptions& options,
              const Progress& progress);

}  // namespace selfcal
