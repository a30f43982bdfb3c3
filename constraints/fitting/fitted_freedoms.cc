#include "constraints/fitting/fitted_freedoms.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kManyEquations = 4;  ///< of a set, over the unknowns: its share of these is small

/// Of a set weighed with `scale`, and what the equations between own unknowns add.
double fitted(const FittedFreedoms& fit, int set, const Scale& scale) {
  Weighting only{fit.noise.used, fit.noise.outlier};
  only.passed_over = true;
  only.scale[set] = scale;
  only.outlier.assign(only.outlier.size(), 1);
  for (const SetPlan::Item& item : fit.equations.plan(set).items)
    only.outlier[item.row] = fit.noise.outlier[item.row];
  const NormalEquations said = fit.equations.normal_equations(fit.state, only, fit.columns);
  const auto n = static_cast<Eigen::Index>(fit.columns.size());
  return fit.covariance(fit.columns, fit.columns).cwiseProduct(said.H.topLeftCorner(n, n)).sum();
}

}  // namespace

std::vector<double> of_small_sets(const FittedFreedoms& fit, double freedom) {
  const auto& sets = fit.equations.data().sets;
  std::vector<double> list(sets.size(), -1);
  for (int s = 0; sets.size() > 1 && s < static_cast<int>(sets.size()); ++s) {
    const auto at = static_cast<std::size_t>(s);
    const double equations = static_cast<double>(fit.equations.plan(s).items.size() *
                                                 sets[at].method->equations().size());
    if (equations > 0 && equations < kManyEquations * freedom)
      list[at] = fitted(fit, s, fit.noise.used[at]) + fit.equations.group_freedoms(s);
  }
  return list;
}

double part_of_lengths(const FittedFreedoms& fit, int set) {
  const std::vector<Quantity> equations = fit.equations.data().sets[set].method->equations();
  const auto angles = static_cast<double>(std::ranges::count(equations, Quantity::angle));
  const double by_scalars = 1 - angles / static_cast<double>(equations.size());
  if (angles == 0 || by_scalars == 0 || fit.equations.plan(set).items.empty() ||
      fit.equations.group_freedoms(set) > 0)
    return by_scalars;
  constexpr double kNothing = HUGE_VAL;  // the sigma of what says nothing
  const Scale& scale = fit.noise.used[set];
  const double both = fitted(fit, set, scale);
  const double lengths = both - fitted(fit, set, {kNothing, scale.angle});
  const double angular = both - fitted(fit, set, {scale.length, kNothing});
  return lengths + angular > 0 ? lengths / (lengths + angular) : by_scalars;
}

}  // namespace selfcal
