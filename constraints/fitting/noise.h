// The noise of each set from its residuals, and the rows that are none of it.
#pragma once

#include <cmath>
#include <vector>

#include "constraints/equations/equations.h"

namespace selfcal {

/// What the estimate needs beside the residuals.
struct NoiseRule {
  double global_freedom = 0;  ///< parameters that the rows determine, spread over all equations
  double most_outliers = 0;   ///< share of a set's rows that may be put aside, and 2 sigma of it
  /// By set, the freedoms that its rows fit, its own unknowns' among them; negative, or empty: its
  /// share of `global_freedom` by its equations. And the most that they did so far, by which a set
  /// has too few left for a noise of its own: it must not come and go.
  std::vector<double> fitted = {}, most_fitted = {};
  /// By set, the part of its fitted freedoms that its lengths carry, where it has angles, too;
  /// empty: that of their scalars.
  std::vector<double> of_lengths = {};
  bool reject = false;  ///< false until the geometry has settled
  /// One noise for all sets of one method and data sheet: until the geometry has settled, a set
  /// that happens to fit well must not take the weight of the others.
  bool pool = false;
  /// A row beyond this chi quantile of its set's robust noise is put aside: one good row in a
  /// million.
  double outlier_quantile = 1 - 1e-6;
};

struct Noise {
  std::vector<Scale> estimated;  ///< by set, floored at least_noise
  std::vector<Scale> used;       ///< the larger of estimated and declared
  std::vector<char> outlier;     ///< by row
  std::vector<char> at_bound;    ///< by set: more rows were far than may be put aside
};

/// Residuals below this are rounding, not noise (of the robot's size, or rad): noise-free data are
/// weighed by it.
inline constexpr double kLeastNoise = 1e-9;
/// The same of `robot` (m, rad).
Scale least_noise(const Robot& robot);

/// Noise of every set with rows, and its rows that lie beyond it.
Noise estimate_noise(const Equations& equations, const std::vector<RowNorm>& norms,
                     const NoiseRule& rule);

/// What the spread of immediate repeats says of the noise of residuals of one unit.
struct RepeatSpread {
  double squares = 0;  ///< m^2 or rad^2
  double freedom = 0;
  /// 1 sigma of one residual (m or rad); negative without repeats.
  double sigma() const { return freedom > 0 ? std::sqrt(squares / freedom) : -1; }
};
struct RepeatSpreads {
  RepeatSpread length, angle;
};
/// Of `set`, from immediate repeats alone. The pure error of a regression with replicates: the
/// residuals of one configuration and approach differ by the measurement's own noise only.
/// `outlier` rows are left out.
RepeatSpreads repeat_spreads(const DataSet& data, int set,
                             const std::vector<RowResidual>& residuals,
                             const std::vector<char>& outlier);

}  // namespace selfcal
