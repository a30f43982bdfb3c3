// Noise by set: robust first (median of the residual lengths over the median of the chi
// distribution), then the root mean square of the rows that stay, both corrected for the fitted
// freedoms (11.34).
#include "constraints/fitting/noise.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/methods/instrument.h"
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
  double equations = 0;
  double own = 0, fitted = 0;  ///< freedoms of its own unknowns, and with its part of the robot's
  double most_fitted = 0;      ///< NoiseRule's, or `fitted`
  double of_lengths = 0;       ///< part of these that the lengths carry

  /// So many equations are left to tell of the robot and of the noise.
  double beyond_own() const { return std::max(equations - own, 0.0); }
  size_t count() const { return plan->items.size(); }
  int row(size_t i) const { return plan->items[i].row; }
  /// Length of the part over the noise of its row.
  double part(size_t i, bool angle) const {
    return (angle ? norms[i].angle : norms[i].length) / data->factor(row(i));
  }
};

/// Squares of what is left of rows, of one set or of several, and of how many scalars they are.
struct Squares {
  double length = 0, angle = 0;  ///< m^2, rad^2
  double lengths = 0, angles = 0;
  double fitted_lengths = 0, fitted_angles = 0;
  double most_fitted = 0;  ///< of both

  void operator+=(const Squares& other) {
    length += other.length;
    angle += other.angle;
    lengths += other.lengths;
    angles += other.angles;
    fitted_lengths += other.fitted_lengths;
    fitted_angles += other.fitted_angles;
    most_fitted += other.most_fitted;
  }

  double freedoms() const { return lengths + angles - most_fitted; }

  /// 1 sigma of one scalar; 1 of a quantity that there is none of.
  Scale sigma() const {
    return {lengths > 0 ? std::sqrt(length / lengths) * freedom_factor(lengths, fitted_lengths) : 1,
            angles > 0 ? std::sqrt(angle / angles) * freedom_factor(angles, fitted_angles) : 1};
  }
};

/// What the squares would be, were all rows as good as the middle one.
Squares robust_squares(const SetNoise& set) {
  const auto rows = static_cast<double>(set.count());
  const auto square = [&](int scalars, bool angle) {
    if (scalars == 0) return 0.0;
    std::vector<double> norms(set.count());
    for (size_t i = 0; i < norms.size(); ++i) norms[i] = set.part(i, angle);
    return rows * scalars * std::pow(median(std::move(norms)) / chi_quantile(scalars, 0.5), 2);
  };
  return {square(set.lengths, false),
          square(set.angles, true),
          rows * set.lengths,
          rows * set.angles,
          set.of_lengths * set.fitted,
          (1 - set.of_lengths) * set.fitted,
          set.most_fitted};
}

Squares squares(const SetNoise& set, const std::vector<char>& outlier) {
  Squares sum;
  sum.fitted_lengths = set.of_lengths * set.fitted;
  sum.fitted_angles = (1 - set.of_lengths) * set.fitted;
  sum.most_fitted = set.most_fitted;
  for (size_t i = 0; i < set.count(); ++i)
    if (!outlier[set.row(i)])
      sum += {std::pow(set.part(i, false), 2),
              std::pow(set.part(i, true), 2),
              static_cast<double>(set.lengths),
              static_cast<double>(set.angles),
              0,
              0};
  return sum;
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

/// By set, the squares of all sets of its instrument together. Where no data sheet bounds the noise
/// and too few freedoms tell it, of all sets of its method or else of all: rows that are met nearly
/// exactly would take all the weight.
std::vector<Squares> pooled(const std::vector<Set>& sets, const std::vector<Squares>& by_set) {
  std::map<Instrument, Squares> of_instrument;
  std::map<std::string_view, Squares> of_method;
  Squares all;
  for (size_t s = 0; s < sets.size(); ++s) {
    of_instrument[instrument_of(sets[s])] += by_set[s];
    of_method[sets[s].method->name()] += by_set[s];
    all += by_set[s];
  }
  std::vector<Squares> list;
  for (const Set& set : sets) {
    const Squares &own = of_instrument[instrument_of(set)], &like = of_method[set.method->name()];
    const bool told = set.noise > 0 || set.noise_angle > 0 || own.freedoms() >= kFewFreedoms;
    list.push_back(told ? own : like.freedoms() >= kFewFreedoms ? like : all);
  }
  return list;
}

}  // namespace

Scale least_noise(const Robot& robot) { return {kLeastNoise * size_of(robot), kLeastNoise}; }

Noise estimate_noise(const Equations& equations, const std::vector<RowNorm>& norms,
                     const NoiseRule& rule) {
  const std::vector<Set>& sets = equations.data().sets;
  std::vector<SetNoise> by_set(sets.size());
  std::vector<Squares> left(sets.size());
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
    set.of_lengths = set.angles == 0           ? 1
                     : rule.of_lengths.empty() ? set.lengths / (set.lengths + set.angles + 0.0)
                                               : rule.of_lengths[s];
    next += set.count();
    set.own = equations.tangent_dimension(static_cast<int>(s)) +
              equations.group_freedoms(static_cast<int>(s));
    total += set.beyond_own();
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
    set.fitted = set.own + (total > 0 ? shared * set.beyond_own() / total : 0);
    set.most_fitted = set.fitted;
    if (!rule.fitted.empty()) {
      set.most_fitted = std::max(set.fitted, rule.most_fitted[s]);
      if (rule.fitted[s] >= 0) set.fitted = rule.fitted[s];
    }
    left[s] = robust_squares(set);
    noise.estimated[s] = left[s].sigma();
    if (!rule.reject) continue;
    noise.at_bound[s] = find_outliers(set, weighed(s), rule, noise.outlier);
    left[s] = squares(set, noise.outlier);
    noise.estimated[s] = left[s].sigma();
  }
  const std::vector<Squares> together = pooled(sets, left);
  for (size_t s = 0; s < sets.size(); ++s)
    if (by_set[s].count() > 0 &&
        (rule.pool || by_set[s].equations - by_set[s].most_fitted < kFewFreedoms))
      noise.estimated[s] = together[s].sigma();
  for (size_t s = 0; s < sets.size(); ++s) {
    noise.estimated[s] = at_least(noise.estimated[s], least.length, least.angle);
    noise.used[s] = weighed(s);
  }
  return noise;
}

RepeatSpreads repeat_spreads(const DataSet& data, int set,
                             const std::vector<RowResidual>& residuals,
                             const std::vector<char>& outlier) {
  RepeatSpreads spreads;
  if (data.rows.repeat.empty()) return spreads;
  std::map<int, std::vector<const RowResidual*>> repeats;
  for (const RowResidual& r : residuals)
    if (r.set == set && data.rows.repeat[r.row] >= 0 && !outlier[r.row])
      repeats[data.rows.repeat[r.row]].push_back(&r);
  for (const auto& [id, rows] : repeats) {
    const int lengths = rows.front()->lengths;
    for (int a = 0; a < lengths + rows.front()->angles; ++a) {
      RepeatSpread& spread = a < lengths ? spreads.length : spreads.angle;
      double mean = 0, weight = 0;
      for (const RowResidual* r : rows) {
        mean += r->scalars[a] / (r->factor * r->factor);
        weight += 1 / (r->factor * r->factor);
      }
      mean /= weight;
      for (const RowResidual* r : rows)
        spread.squares += std::pow((r->scalars[a] - mean) / r->factor, 2);
      spread.freedom += static_cast<double>(rows.size()) - 1;
    }
  }
  return spreads;
}

}  // namespace selfcal
