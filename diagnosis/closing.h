// How far the gap closes: the geometry alone against the geometry with the named effects, both
// identified from the `fit` rows by the full, nonlinear identification and judged on the others.
#pragma once

#include <memory>
#include <vector>

#include "constraints/adjustment.h"
#include "diagnosis/diagnosis.h"

namespace selfcal {

struct Closing {
  std::vector<JudgedRow> judged;
  Adjusted after;
  std::shared_ptr<const Robot> model;  ///< of `after`
  std::vector<Rejected> rejected;      ///< judging rows that neither model explains
};

/// `before` is the geometry's own adjustment; the parameters of `correction` are identified.
/// `noise` is 1 sigma of one scalar (m).
Closing close_gap(const std::shared_ptr<const Robot>& geometry, const Adjusted& before,
                  const DataSet& data, const Correction& correction, const Site& site, double noise,
                  const DiagnosisOptions& options);

}  // namespace selfcal
