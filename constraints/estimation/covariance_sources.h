// What the doubt of the fitted unknowns comes from.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <string_view>
#include <vector>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// One part of the covariance of columns().
struct CovarianceSource {
  std::string_view name;
  Eigen::MatrixXd C;
  double freedoms = HUGE_VAL;  ///< that tell its size; infinite where that is given
};

/// Noise of the rows (beside the rounding of the encoders and what repeats differ by, and what
/// these have in common), the maker's tolerances, the scale where a length is held for it, what was
/// given (see posterior.h), and what halves of the rows differ by beside all that, in time and by
/// configuration, judged by the end position with `weight` (see endpoint_deviations()). `R` is
/// whitened, with the columns beside the unknowns.
std::vector<CovarianceSource> covariance_sources(const Equations& equations,
                                                 const Adjusted& adjusted, const Eigen::MatrixXd& R,
                                                 const Eigen::MatrixXd& weight);

/// Equations that took part, less the freedoms of the unknowns that these determine.
double freedoms_left(const Equations& equations, const Adjusted& adjusted);

/// The sum of all.
Eigen::MatrixXd sum(const std::vector<CovarianceSource>& sources);

}  // namespace selfcal
