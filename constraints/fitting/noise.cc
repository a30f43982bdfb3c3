// Noise by set: robust first (median of the residual lengths over the median of the chi
// distribution), then the root mean square of the rows that stay, both corrected for the fitted
// freedoms (11.34).
#include "constraints/fitting/noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "constraints/statistics.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// Equations over equations less fitted freedoms, at most 10: a set with hardly more equations than
/// unknowns says little of its noise.
double freedom_factor(double equations, double fitted) {
  return std::sqrt(equations / std::max(equations - fitted, 0.1 * equations));
}

/// A set with fewer freedoms left has no noise of its own to speak of: its kind's is taken.
constexpr double kFewFreedoms = 10;

struct SetNoise {
  const RowNorm* norms = nullptr;  ///< of the set's items, in their order
  const SetPlan* plan = nullptr;
  const Observations* data = nullptr;
  int lengths = 0, angles = 0;  ///< scalars of a row
  double equations = 0, fitted = 0;

  size_t count() const { return plan->items.size(); }
  int row(size_t i) const { return plan->items[i].row; }
  /// Length of the part over the noise of its row.
  double part(size_t i, bool angle) const {
    return (angle ? norms[i].angle : norms[i].length) / data->factor(row(i));
  }
};

double robust(const SetNoise& set, bool angle) {
  const int scalars = angle ? set.angles : set.lengths;
  if (scalars == 0) return 1;
  std::vector<double> norms(set.count());
  for (size_t i = 0; i < norms.size(); ++i) norms[i] = set.part(i, angle);
  return median(std::move(norms)) / chi_quantile(scalars, 0.5) *
         freedom_factor(set.equations, set.fitted);
}

double root_mean_square(const SetNoise& set, const std::vector<char>& outlier, bool angle) {
  double sum = 0, count = 0, kept = 0;
  for (size_t i = 0; i < set.count(); ++i) {
    if (outlier[set.row(i)]) continue;
    const double part = set.part(i, angle);
    sum += part * part;
    count += angle ? set.angles : set.lengths;
    kept += set.angles + set.lengths;
  }
  if (count == 0) return 1;
  return std::sqrt(sum / count) * freedom_factor(kept, set.fitted);
}

Scale at_least(Scale a, double length, double angle) {
  return {std::max(a.length, length), std::max(a.angle, angle)};
}

/// Puts the rows aside that lie farther than any noise of their set, the farthest first, within the
/// bound.
bool find_outliers(const SetNoise& set, const Scale& scale, const NoiseRule& rule,
                   std::vector<char>& outlier) {
  std::vector<std::pair<double, int>> far;
  const double most_sigmas = chi_quantile(set.lengths + set.angles, rule.outlier_quantile);
  for (size_t i = 0; i < set.count(); ++i) {
    const double t = std::hypot(set.part(i, false) / scale.length, set.part(i, true) / scale.angle);
    if (t > most_sigmas) far.emplace_back(-t, set.row(i));
  }
  std::sort(far.begin(), far.end());
  // The share and two sigma of its own scatter: a small set may well have three false rows at 2 %.
  const double share = rule.most_outliers * static_cast<double>(set.count());
  const size_t most = static_cast<size_t>(share + 2 * std::sqrt(share));
  for (size_t i = 0; i < std::min(most, far.size()); ++i) outlier[far[i].second] = 1;
  return far.size() > most;
}

/// Root mean squares of the scales over all sets of one method and stated noise, weighed by
/// equations.
void pool(const std::vector<Set>& sets, const std::vector<SetNoise>& by_set,
          std::vector<Scale>& scales) {
  using Kind = std::tuple<std::string_view, double, double>;
  struct Sum {
    double length = 0, angle = 0, weight = 0;
  };
  std::map<Kind, Sum> sums;
  const auto kind = [&](size_t s) {
    return Kind(sets[s].method->name(), sets[s].noise, sets[s].noise_angle);
  };
  for (size_t s = 0; s < sets.size(); ++s) {
    Sum& sum = sums[kind(s)];
    sum.length += by_set[s].equations * scales[s].length * scales[s].length;
    sum.angle += by_set[s].equations * scales[s].angle * scales[s].angle;
    sum.weight += by_set[s].equations;
  }
  for (size_t s = 0; s < sets.size(); ++s) {
    const Sum& sum = sums[kind(s)];
    if (by_set[s].equations > 0)
      scales[s] = {std::sqrt(sum.length / sum.weight), std::sqrt(sum.angle / sum.weight)};
  }
}

}  // namespace

Scale least_noise(const Robot& robot) { return {kLeastNoise * size_of(robot), kLeastNoise}; }

Noise estimate_noise(const Equations& equations, const std::vector<RowNorm>& norms,
                     const NoiseRule& rule) {
  const std::vector<Set>& sets = equations.data().sets;
  std::vector<SetNoise> by_set(sets.size());
  double total = 0;
  const RowNorm* next = norms.data();
  for (size_t s = 0; s < sets.size(); ++s) {
    SetNoise& set = by_set[s];
    set.norms = next;
    set.plan = &equations.plan(static_cast<int>(s));
    set.data = &equations.data().rows;
    for (const Quantity quantity : sets[s].method->equations())
      ++(quantity == Quantity::angle ? set.angles : set.lengths);
    set.equations = static_cast<double>(set.count()) * (set.lengths + set.angles);
    next += set.count();
    total += set.equations;
  }
  Noise noise;
  noise.estimated.resize(sets.size());
  noise.used.resize(sets.size());
  noise.at_bound.assign(sets.size(), 0);
  noise.outlier.assign(equations.data().rows.rows(), 0);
  const Scale least = least_noise(equations.robot());
  const auto weighed = [&](size_t s) {
    const Scale floored = at_least(noise.estimated[s], least.length, least.angle);
    const Scale& stated = equations.stated(static_cast<int>(s));
    return at_least(floored, stated.length, stated.angle);
  };
  for (size_t s = 0; s < sets.size(); ++s) {
    SetNoise& set = by_set[s];
    if (set.count() == 0) continue;
    const double shared = std::max(rule.global_freedom - equations.nuisance_columns(), 0.0);
    set.fitted = shared * set.equations / total + equations.tangent_dimension(static_cast<int>(s)) +
                 equations.group_freedoms(static_cast<int>(s));
    noise.estimated[s] = {robust(set, false), robust(set, true)};
    if (!rule.reject) continue;
    noise.at_bound[s] = find_outliers(set, weighed(s), rule, noise.outlier);
    noise.estimated[s] = {root_mean_square(set, noise.outlier, false),
                          root_mean_square(set, noise.outlier, true)};
  }
  std::vector<Scale> pooled = noise.estimated;
  pool(sets, by_set, pooled);
  for (size_t s = 0; s < sets.size(); ++s)
    if (rule.pool || by_set[s].equations - by_set[s].fitted < kFewFreedoms)
      noise.estimated[s] = pooled[s];
  for (size_t s = 0; s < sets.size(); ++s) {
    noise.estimated[s] = at_least(noise.estimated[s], least.length, least.angle);
    noise.used[s] = weighed(s);
  }
  return noise;
}

double repeat_sigma(const DataSet& data, int set, const std::vector<RowResidual>& residuals,
                    const std::vector<char>& outlier) {
  if (data.rows.repeat.empty()) return -1;
  std::map<int, std::vector<const RowResidual*>> repeats;
  for (const RowResidual& r : residuals)
    if (r.set == set && data.rows.repeat[r.row] >= 0 && !outlier[r.row])
      repeats[data.rows.repeat[r.row]].push_back(&r);
  double sum = 0, freedom = 0;
  for (const auto& [id, rows] : repeats)
    for (int a = 0; a < rows.front()->lengths; ++a) {
      double mean = 0, weight = 0;
      for (const RowResidual* r : rows) {
        mean += r->scalars[a] / (r->factor * r->factor);
        weight += 1 / (r->factor * r->factor);
      }
      mean /= weight;
      for (const RowResidual* r : rows) sum += std::pow((r->scalars[a] - mean) / r->factor, 2);
      freedom += static_cast<double>(rows.size()) - 1;
    }
  return freedom > 0 ? std::sqrt(sum / freedom) : -1;
}

}  // namespace selfcal
