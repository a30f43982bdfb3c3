// Rows kept aside that lie beyond the noise only because what predicts them is in doubt itself.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/estimation/judgement.h"

namespace selfcal {

/// Rows that identified nothing as the fit's columns predict them, over their noise: where these
/// have the covariance C, `y` has I + W C W^T.
struct Predicted {
  Eigen::VectorXd y;     ///< equations
  Eigen::MatrixXd W;     ///< equations x columns of the fit: their derivatives
  std::vector<int> row;  ///< by equation, of the data set
};

/// The `check` rows of `after` that are `asked` (by check row) and predicted. Of sets whose own
/// unknowns were fitted to rows that judge, of shared points and of differences that share a touch
/// none is.
Predicted predicted(const DataSet& data, const Equations& fit_equations, const Judged& after,
                    const std::vector<char>& asked);

/// y^T (I + W C W^T)^-1 y: chi-square of as many freedoms as equations, if noise is all.
double squared_distance(const Eigen::VectorXd& y, const Eigen::MatrixXd& W,
                        const Eigen::MatrixXd& C);

/// By `check` row of `after`: lies beyond the noise (is_outlier), and yet within what noise and the
/// parameters' doubt make of it together (squared_distance). `C` is the covariance of the columns
/// of `fit_equations`. None that is not predicted is.
std::vector<char> foreseen(const DataSet& data, const Equations& fit_equations,
                           const Eigen::MatrixXd& C, const Judged& after);

}  // namespace selfcal
