// How far the gap closes: the geometry alone, with the named effects alone, and with everything
// found, each identified from the `fit` rows by the full, nonlinear identification and judged on
// the others.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "constraints/estimation/adjustment.h"
#include "diagnosis/findings.h"

namespace selfcal {

struct HoldoutValidation {
  std::vector<ValidationRow> rows;
  std::shared_ptr<const Robot> model;  ///< with everything found
  Adjusted all;                        ///< its fit
  bool converged = true;               ///< every fit that was judged
  std::string stop_reason;             ///< of the first one that did not converge
  std::vector<Outlier> outliers;       ///< validation rows that no model explains
  int undecided = 0;                   ///< validation rows that judge nothing
};

/// `before` is the geometry's own adjustment; the parameters of `correction` are identified, those
/// of its named effects once more without the others.
/// `noise` is 1 sigma of one scalar by set (m). Rows that are `undecided` (by row of the data set)
/// judge nothing: a step that is found may lie before or behind them.
HoldoutValidation validate_on_holdout(const std::shared_ptr<const Robot>& geometry,
                                      const Adjusted& before, const DataSet& data,
                                      const Correction& correction,
                                      const MeasurementContext& context,
                                      const std::vector<double>& noise,
                                      const std::vector<char>& undecided,
                                      const DiagnosisOptions& options);

}  // namespace selfcal
