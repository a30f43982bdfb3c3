// The rows that fitted and those that judge are taken together, by their time.
#include "constraints/estimation/lock_slip.h"

#include <algorithm>
#include <cmath>

#include "constraints/estimation/change_point.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// Residuals of the set's rows that have one, with the rows.
struct Left {
  std::vector<int> rows;
  Eigen::MatrixXd residuals;
};

Left left_of(const DataSet& data, const Judged& after, int set) {
  std::vector<const RowResidual*> by_row(static_cast<std::size_t>(data.rows.rows()), nullptr);
  for (const auto* list : {&after.fit, &after.check})
    for (const RowResidual& each : *list)
      if (each.set == set && std::isfinite(each.angle))
        by_row[static_cast<std::size_t>(each.row)] = &each;
  Left left;
  for (const int row : rows_in_time(data.rows, set))
    if (by_row[static_cast<std::size_t>(row)]) left.rows.push_back(row);
  left.residuals.resize(static_cast<Eigen::Index>(left.rows.size()), 2);
  for (Eigen::Index i = 0; i < left.residuals.rows(); ++i) {
    const RowResidual& each = *by_row[static_cast<std::size_t>(left.rows[i])];
    left.residuals.row(i) << each.scalars[0], each.scalars[1];
  }
  return left;
}

}  // namespace

std::vector<int> rows_in_time(const Observations& rows, int set) {
  std::vector<int> list;
  for (int row = 0; row < rows.rows(); ++row)
    if (rows.set[row] == set) list.push_back(row);
  if (rows.time.rows() > 0)
    std::ranges::stable_sort(list, {}, [&](int row) { return rows.time[row]; });
  return list;
}

std::vector<LockSlip> lock_slips(const DataSet& data, const Judged& after) {
  std::vector<LockSlip> slips;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) {
    const Set& set = data.sets[s];
    if (set.method->planned() != Planned::lock) continue;
    const Left left = left_of(data, after, s);
    const auto found =
        change_point(left.residuals, std::max(set.noise_angle, kLeastNoise), kFewestBesideSlip);
    if (!found || found->p_value > kFalseSlips) continue;
    slips.push_back({set.name, set.method->lock(), left.rows[found->at - 1], left.rows[found->at],
                     found->step.norm(), found->statistic});
  }
  return slips;
}

std::string slip_words(const LockSlip& slip) {
  return "the lock of " + slip.lock + " (set " + slip.set + ") slipped by " +
         with_figures("%.3g mrad", 1e3 * slip.angle) + " between its rows " +
         std::to_string(slip.before + 1) + " and " + std::to_string(slip.after + 1);
}

}  // namespace selfcal
