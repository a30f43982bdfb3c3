// The freedoms that the rows of each set fit, of those that all fit together: the trace of what
// they say of the parameters times the covariance of these.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/fitting/noise.h"

namespace selfcal {

/// A fit, as far as its rows are asked for their part in it.
struct FittedFreedoms {
  const Equations& equations;
  const State& state;
  const std::vector<int>& columns;  ///< that are free
  const Noise& noise;
  const Eigen::MatrixXd& covariance;  ///< of all columns
};

/// By set, the freedoms that the rows of a small one among others fit, its own unknowns' among
/// them: one that is taken for quieter than it is is met the better for it, and would be taken for
/// quieter still. Negative of those with far more equations than unknowns, and of one set alone.
/// `freedom`: of all rows.
std::vector<double> of_small_sets(const FittedFreedoms& fit, double freedom);

/// Of the freedoms that the rows of a set fit, those of its lengths, by what lengths and angles add
/// to what is said of the parameters; where groups are fitted, too, by their scalars.
double part_of_lengths(const FittedFreedoms& fit, int set);

}  // namespace selfcal
