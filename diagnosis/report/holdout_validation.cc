// A validation row that no model comes near would drown every figure: it is left out of them, and
// figures with it stand beside them. It is named as false where the geometry's own doubt does not
// foresee it.
#include "diagnosis/report/holdout_validation.h"

#include <algorithm>
#include <cmath>

#include "constraints/estimation/judgement.h"
#include "constraints/estimation/prediction.h"
#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "diagnosis/report/fitted_correction.h"
#include "diagnosis/validation/folds.h"

namespace selfcal {
namespace {

/// The validation rows as each model leaves them.
struct Left {
  Judged nominal, geometric, named, whole;
};

/// The figures of every validation row, and which of them no model comes near.
void take_rows(const Left& left, const DataSet& data, const std::vector<double>& noise,
               const std::vector<char>& undecided, HoldoutValidation& validation) {
  // A set that only judges has a noise of its own: what its data sheet says, or what the
  // best of the models leaves.
  const Judged& whole = left.whole;
  const auto noise_of = [&](int set) {
    if (!whole.aligned[set]) return noise[set];
    if (data.sets[set].noise > 0) return data.sets[set].noise;
    return std::min({left.geometric.check_scale[set].length, left.named.check_scale[set].length,
                     whole.check_scale[set].length});
  };
  const auto square = [](const RowResidual& row) { return row.length * row.length; };
  const std::vector<int> block = validation_blocks(data);
  for (size_t i = 0; i < whole.check.size(); ++i) {
    const RowResidual& before = left.geometric.check[i];
    const RowResidual& after = left.named.check[i];
    const RowResidual& all = whole.check[i];
    if (all.lengths == 0) continue;
    if (undecided[all.row]) {
      ++validation.undecided;
      continue;
    }
    const double near = std::min({before.length, after.length, all.length});
    const double limit = chi_quantile(all.lengths, kDiagnosis.validation.far);
    const bool false_reading =
        near > kDiagnosis.validation.beyond * limit * all.factor *
                   std::max(noise[all.set], whole.check_scale[all.set].length);
    if (false_reading && !left.geometric.foreseen[i])
      validation.outliers.push_back({all.row + 1, data.sets[all.set].name, all.length, true,
                                     "neither the geometry nor any effect found comes near it"});
    validation.rows.push_back(
        {square(left.nominal.check[i]), square(before), square(after), square(all),
         all.lengths * std::pow(all.factor * noise_of(all.set), 2), block[all.row], false_reading});
  }
}

}  // namespace

HoldoutValidation validate_on_holdout(const std::shared_ptr<const Robot>& geometry,
                                      const Adjusted& before, const DataSet& data,
                                      const Correction& correction,
                                      const MeasurementContext& context,
                                      const std::vector<double>& noise,
                                      const std::vector<char>& undecided,
                                      const DiagnosisOptions& options) {
  HoldoutValidation validation;
  const auto note = [&](const Fit& fit) {
    if (validation.converged && !fit.converged) validation.stop_reason = fit.stop_reason;
    validation.converged = validation.converged && fit.converged;
  };
  const Equations plain(*geometry, data, Use::fit);
  FittedCorrection all =
      fit_correction(geometry, data, correction, context, options, &before.fitted.state);
  Left left{judge(*geometry, data, plain, before.before),
            judge(*geometry, data, plain, before.fitted),
            {},
            all.judged(data)};
  left.geometric.foreseen = foreseen(data, plain, before.fitted.covariance, left.geometric);
  note(before.fitted);
  note(all.adjusted.fitted);
  const Correction names = named_of(correction);
  if (names.empty()) {
    left.named = left.geometric;
  } else if (names.size() == correction.size() || left.whole.check.empty()) {
    left.named = left.whole;
  } else {
    const FittedCorrection alone =
        fit_correction(geometry, data, names, context, options, &before.fitted.state);
    left.named = alone.judged(data);
    note(alone.adjusted.fitted);
  }
  take_rows(left, data, noise, undecided, validation);
  validation.model = std::move(all.model);
  validation.all = std::move(all.adjusted);
  return validation;
}

}  // namespace selfcal
