#include "constraints/estimation/check_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kSignificance = 0.05;
/// Normal quantile of the same, and how much the squares of angles that say little may rise.
constexpr double kRise = 1.645, kLittle = 0.1;

/// A false reading: far under both models, each by its own noise, and no farther under the new one
/// than the old one's noise explains. What the new model alone makes far counts, however far it is.
bool is_false(const CheckRow& before, const CheckRow& after) {
  return before.outlier && after.outlier && after.residual - before.residual < before.noise;
}

/// What became of one set's squares.
struct SetChange {
  double gain = 0;                                       ///< of the residuals
  bool aligned = false, angle_alone = false;             ///< as CheckRow
  double angle_before = 0, angle_loss = 0, scatter = 0;  ///< of the angles; of their losses

  void add(const CheckRow& before, const CheckRow& after) {
    gain += std::pow(before.residual, 2) - std::pow(after.residual, 2);
    aligned = after.aligned;
    angle_alone = after.angle_alone;
    const double b = std::pow(before.angle, 2), a = std::pow(after.angle, 2);
    angle_before += b;
    angle_loss += a - b;
    scatter += std::pow(a - b, 2);
  }
  /// Angles in which noise outweighs the robot may say nothing, but must not contradict.
  bool angles_rise() const {
    return angle_loss > kLittle * angle_before && angle_loss > kRise * std::sqrt(scatter);
  }
};

/// Calls `what` with each row before and after.
template <class What>
void for_each_pair(const std::vector<CheckRow>& before, const std::vector<CheckRow>& after,
                   const What& what) {
  for (std::size_t b = 0, a = 0; b < before.size() && a < after.size();) {
    if (before[b].row < after[a].row) {
      ++b;
    } else if (after[a].row < before[b].row) {
      ++a;
    } else {
      what(before[b++], after[a++]);
    }
  }
}

/// Of each configuration, on average over its repeats; `by_noise` in units of each row's noise.
std::vector<double> gains(const std::vector<CheckRow>& before, const std::vector<CheckRow>& after,
                          bool by_noise) {
  std::map<int, std::pair<double, double>> gain_and_rows;
  for_each_pair(before, after, [&](const CheckRow& b, const CheckRow& a) {
    auto& [gain, rows] = gain_and_rows[a.configuration];
    gain += (b.residual - a.residual) / (by_noise ? b.noise : 1);
    ++rows;
  });
  std::vector<double> list;
  list.reserve(gain_and_rows.size());
  for (const auto& [configuration, sum] : gain_and_rows) list.push_back(sum.first / sum.second);
  return list;
}

}  // namespace

bool CheckComparison::better() const {
  return p_value < kSignificance && lengths_fall && !angles_rise;
}

CheckComparison compare_check_rows(const std::vector<CheckRow>& before,
                                   const std::vector<CheckRow>& after) {
  CheckComparison compared;
  const bool alone = std::ranges::all_of(after, &CheckRow::angle_alone);
  const bool alike = alone || std::ranges::none_of(after, &CheckRow::angle_alone);
  double rows = 0, gain = 0;
  std::map<int, SetChange> sets;
  for_each_pair(before, after, [&](const CheckRow& b, const CheckRow& a) {
    if (a.angle_alone == alone && !b.outlier && !a.outlier) {
      compared.rms_before += b.residual * b.residual;
      compared.rms_after += a.residual * a.residual;
      ++rows;
    }
    if (!is_false(b, a)) sets[a.set].add(b, a);
  });
  if (rows > 0) {
    compared.rms_before = std::sqrt(compared.rms_before / rows);
    compared.rms_after = std::sqrt(compared.rms_after / rows);
  }
  const std::vector<double> gained = gains(before, after, !alike);
  compared.configurations = static_cast<int>(gained.size());
  compared.p_value = signed_rank_p(gained);
  // Of all, and of each set that only judges: many small gains must not outvote one great loss.
  const auto change_of = [](const auto& each) -> const SetChange& { return each.second; };
  const auto counts = [&](const SetChange& each) { return each.angle_alone == alone; };
  for (const auto& [set, change] : sets) gain += counts(change) ? change.gain : 0;
  const auto loses = [&](const SetChange& each) {
    return counts(each) && each.aligned && each.gain < 0;
  };
  compared.lengths_fall = gain > 0 && std::ranges::none_of(sets, loses, change_of);
  compared.angles_rise = std::ranges::any_of(sets, &SetChange::angles_rise, change_of);
  return compared;
}

}  // namespace selfcal
