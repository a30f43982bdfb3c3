// y^T (I + W C W^T)^-1 y over its equations is an F variable where noise is all: y the rows kept
// aside over their noise, W their derivatives, C the covariance of what predicts them.
#include "diagnosis/report/beyond_noise.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/estimation/judgement.h"
#include "constraints/estimation/prediction.h"
#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// Rows kept aside that are no false readings, of the end's position or of its angles, some all
/// over of many: by check row.
struct Asked {
  std::vector<char> rows;
  bool all = false;  ///< more than a few would be false: something else is, and none is left out
};
Asked asked_of(const Judged& judged, const std::vector<Outlier>& outliers, Eigen::Index rows) {
  std::vector<char> false_row(static_cast<size_t>(rows), 0);
  for (const Outlier& each : outliers)
    if (each.check) false_row[static_cast<size_t>(each.row - 1)] = 1;
  const auto is_false = [&](const RowResidual& row) {
    return false_row[static_cast<size_t>(row.row)] != 0 || is_outlier(row, judged);
  };
  const auto count = static_cast<double>(judged.check.size());
  Asked asked{std::vector<char>(judged.check.size(), 0),
              static_cast<double>(std::ranges::count_if(judged.check, is_false)) >
                  kDiagnosis.report.few_false * count};
  const size_t every = judged.check.size() / kDiagnosis.report.most_beyond_noise + 1;
  for (size_t i = 0; i < judged.check.size(); i += every)
    asked.rows[i] = asked.all || !is_false(judged.check[i]);
  return asked;
}

/// What a row of each set errs by, as far as noise goes: of sets that only judge what their file
/// says, or what the others have.
std::vector<Scale> noise_of(const LinearisedModel& linearised, const DataSet& data, double noise) {
  std::vector<Scale> list = linearised.noise_of_sets();
  for (size_t s = 0; s < list.size(); ++s) {
    const bool fitted = linearised.adjusted().fitted.rows[s] > 0;
    const double declared = data.sets[s].noise;
    list[s].length = fitted         ? list[s].length * noise / linearised.noise()
                     : declared > 0 ? declared
                                    : noise;
  }
  return list;
}

/// Equations that tell as much as independent ones: repeats of a configuration share what the
/// geometry leaves of it.
double independent(const Predicted& rows, const DataSet& data) {
  const std::vector<int> configuration = configurations(data.rows);
  std::set<int> seen, places;
  for (const int row : rows.row) {
    seen.insert(row);
    places.insert(configuration[static_cast<size_t>(row)]);
  }
  return static_cast<double>(rows.y.size()) * static_cast<double>(places.size()) /
         std::max(1.0, static_cast<double>(seen.size()));
}

}  // namespace

std::string beyond_noise(const LinearisedModel& linearised, const DataSet& data,
                         const Diagnosis& diagnosis) {
  if (diagnosis.verdict.effect != kNone || !(linearised.noise() > 0)) return {};
  const Fit& fitted = linearised.adjusted().fitted;
  Judged judged = judge(linearised.geometry(), data, linearised.equations(), fitted);
  judged.check_scale = noise_of(linearised, data, diagnosis.noise);
  const Asked asked = asked_of(judged, diagnosis.outliers, data.rows.rows());
  const Predicted rows = predicted(data, linearised.equations(), judged, asked.rows);
  const double equations = independent(rows, data);
  if (equations < kDiagnosis.report.fewest_beyond_noise) return {};
  const double ratio =
      squared_distance(rows.y, rows.W, fitted.covariance) / static_cast<double>(rows.y.size());
  const double freedom = std::min(diagnosis.floor_freedom, 1e6);
  if (ratio <= std::pow(kDiagnosis.report.beyond_noise, 2) ||
      f_exceeds(ratio, equations, freedom) > kDiagnosis.report.beyond_noise_by_chance)
    return {};
  const Gap& gap = diagnosis.gap;
  const double left = asked.all ? gap.with_false_rows.before : gap.rms_before;
  return "calibration leaves " + in_readable_unit(left, "m") + " of the rows kept aside, " +
         plain_figure(std::sqrt(ratio)) +
         " times what noise and its own doubt explain: what is there the other rows do not tell";
}

}  // namespace selfcal
