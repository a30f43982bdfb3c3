// Noise by set: robust first (median of the residual lengths over the median of the chi
// distribution), then the root mean square of the rows that stay, both corrected for the fitted
// freedoms (11.34).
#include "constraints/estimation/noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "constraints/statistics.h"

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
  std::vector<const RowResidual*> rows;
  double equations = 0, fitted = 0;
};

double robust(const SetNoise& set, bool angle) {
  std::vector<double> norms;
  for (const RowResidual* r : set.rows) norms.push_back((angle ? r->angle : r->length) / r->factor);
  const int count = angle ? set.rows.front()->angles : set.rows.front()->lengths;
  if (count == 0) return 1;
  return median(std::move(norms)) / chi_quantile(count, 0.5) *
         freedom_factor(set.equations, set.fitted);
}

double root_mean_square(const SetNoise& set, const std::vector<char>& outlier, bool angle) {
  double sum = 0, count = 0, kept = 0;
  for (const RowResidual* r : set.rows) {
    if (outlier[r->row]) continue;
    sum += std::pow((angle ? r->angle : r->length) / r->factor, 2);
    count += angle ? r->angles : r->lengths;
    kept += r->angles + r->lengths;
  }
  if (count == 0) return 1;
  return std::sqrt(sum / count) * freedom_factor(kept, set.fitted);
}

Scale at_least(Scale a, double length, double angle) {
  return {std::max(a.length, length), std::max(a.angle, angle)};
}

/// Puts the rows aside that lie farther than any noise of their set, the farthest first, within the
/// bound.
bool put_far_rows_aside(const SetNoise& set, const Scale& scale, const NoiseRule& rule,
                        std::vector<char>& outlier) {
  std::vector<std::pair<double, int>> far;
  for (const RowResidual* r : set.rows) {
    const double t = r->sigmas(scale);
    if (t > chi_quantile(r->lengths + r->angles, rule.far_quantile)) far.emplace_back(-t, r->row);
  }
  std::sort(far.begin(), far.end());
  // The share and two sigma of its own scatter: a small set may well have three false rows at 2 %.
  const double share = rule.most_rejected * static_cast<double>(set.rows.size());
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

Noise estimate_noise(const Equations& equations, const std::vector<RowResidual>& residuals,
                     const NoiseRule& rule) {
  const std::vector<Set>& sets = equations.data().sets;
  std::vector<SetNoise> by_set(sets.size());
  double total = 0;
  for (const RowResidual& r : residuals) {
    by_set[r.set].rows.push_back(&r);
    by_set[r.set].equations += r.lengths + r.angles;
    total += r.lengths + r.angles;
  }
  Noise noise;
  noise.estimated.resize(sets.size());
  noise.used.resize(sets.size());
  noise.at_bound.assign(sets.size(), 0);
  noise.outlier.assign(equations.data().rows.rows(), 0);
  const auto weighed = [&](size_t s) {
    const Scale floored = at_least(noise.estimated[s], kLeastNoise, kLeastNoise);
    const Scale& stated = equations.stated(static_cast<int>(s));
    return at_least(floored, stated.length, stated.angle);
  };
  for (size_t s = 0; s < sets.size(); ++s) {
    SetNoise& set = by_set[s];
    if (set.rows.empty()) continue;
    const double shared = std::max(rule.global_freedom - equations.nuisance_columns(), 0.0);
    set.fitted = shared * set.equations / total + equations.tangent_dimension(static_cast<int>(s)) +
                 equations.group_freedoms(static_cast<int>(s));
    noise.estimated[s] = {robust(set, false), robust(set, true)};
    if (!rule.reject) continue;
    noise.at_bound[s] = put_far_rows_aside(set, weighed(s), rule, noise.outlier);
    noise.estimated[s] = {root_mean_square(set, noise.outlier, false),
                          root_mean_square(set, noise.outlier, true)};
  }
  std::vector<Scale> pooled = noise.estimated;
  pool(sets, by_set, pooled);
  for (size_t s = 0; s < sets.size(); ++s)
    if (rule.pool || by_set[s].equations - by_set[s].fitted < kFewFreedoms)
      noise.estimated[s] = pooled[s];
  for (size_t s = 0; s < sets.size(); ++s) {
    noise.estimated[s] = at_least(noise.estimated[s], kLeastNoise, kLeastNoise);
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
      double mean = 0;
      for (const RowResidual* r : rows) mean += r->scalars[a] / static_cast<double>(rows.size());
      for (const RowResidual* r : rows) sum += std::pow(r->scalars[a] - mean, 2);
      freedom += static_cast<double>(rows.size()) - 1;
    }
  return freedom > 0 ? std::sqrt(sum / freedom) : -1;
}

}  // namespace selfcal
