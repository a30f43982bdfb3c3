// Rows kept aside that lie beyond the noise only because what predicts them is in doubt itself.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/estimation/judgement.h"

namespace selfcal {

/// By `check` row of `after`: lies beyond the noise (is_outlier), and yet within what noise and the
/// parameters' doubt make of it together, r^T (I + W C W^T)^-1 r against the quantile of noise. `C`
/// is the covariance of the columns of `fit_equations`. Of sets whose own unknowns were fitted to
/// rows that judge, of shared points and of differences that share a touch none is.
std::vector<char> foreseen(const DataSet& data, const Equations& fit_equations,
                           const Eigen::MatrixXd& C, const Judged& after);

}  // namespace selfcal
