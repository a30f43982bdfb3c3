// y^T (I + W C W^T)^-1 y over its equations is an F variable where noise is all: y the rows kept
// aside over their noise, W their derivatives, C the covariance of what predicts them.
#include "diagnosis/report/beyond_noise.h"

#include <algorithm>
#include <cmath>

#include "constraints/estimation/judgement.h"
#include "constraints/estimation/prediction.h"
#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// Rows kept aside that are not false readings, some all over of many: by check row. Where more
/// than a few would be false, something else is, and none is left out.
std::vector<char> judging(const Judged& judged, const std::vector<Outlier>& outliers) {
  const auto is_false = [&](const RowResidual& row) {
    return std::ranges::any_of(
        outliers, [&](const Outlier& each) { return each.check && each.row == row.row + 1; });
  };
  const auto count = static_cast<double>(judged.check.size());
  const bool few = static_cast<double>(std::ranges::count_if(judged.check, is_false)) <=
                   kDiagnosis.report.few_false * count;
  std::vector<char> asked(judged.check.size(), 0);
  const size_t every = judged.check.size() / kDiagnosis.report.most_beyond_noise + 1;
  for (size_t i = 0; i < asked.size(); i += every) asked[i] = !few || !is_false(judged.check[i]);
  return asked;
}

}  // namespace

std::string beyond_noise(const LinearisedModel& linearised, const DataSet& data,
                         const Diagnosis& diagnosis) {
  const double pooled = linearised.noise();
  if (diagnosis.verdict.effect != kNone || !(pooled > 0)) return {};
  const Fit& fitted = linearised.adjusted().fitted;
  Judged judged = judge(linearised.geometry(), data, linearised.equations(), fitted);
  judged.check_scale = linearised.noise_of_sets();
  for (Scale& each : judged.check_scale) each.length *= diagnosis.noise / pooled;
  const Predicted rows =
      predicted(data, linearised.equations(), judged, judging(judged, diagnosis.outliers));
  const auto equations = static_cast<double>(rows.y.size());
  if (equations < kDiagnosis.report.fewest_beyond_noise) return {};
  const double ratio = squared_distance(rows.y, rows.W, fitted.covariance) / equations;
  const double freedom = std::min(diagnosis.floor_freedom, 1e6);
  if (ratio <= std::pow(kDiagnosis.report.beyond_noise, 2) ||
      f_exceeds(ratio, equations, freedom) > kDiagnosis.report.beyond_noise_by_chance)
    return {};
  const Gap& gap = diagnosis.gap;
  const double left = gap.false_rows > 0 ? gap.with_false_rows.before : gap.rms_before;
  return "calibration leaves " + in_readable_unit(left, "m") + " of the rows kept aside, " +
         plain_figure(std::sqrt(ratio)) +
         " times what noise and its own doubt explain: what is there the other rows do not tell";
}

}  // namespace selfcal
