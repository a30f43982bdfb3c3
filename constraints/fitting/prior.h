// What is believed of the columns before any row is seen.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"

namespace selfcal {

/// Gaussian priors of the robot's parameters; those that are not free stay where they are.
struct Prior {
  Eigen::VectorXd centre, sigma;
  std::vector<char> free;
  bool use = true;  ///< false: no prior on free parameters
};

/// The columns that are free: free parameters and all own freedoms.
std::vector<int> free_columns(const Equations& equations, const Prior& prior);

/// The squares of prior_weight() of columns(); the robot's own zero without priors.
Eigen::VectorXd prior_precision(const Equations& equations, const Prior& prior);

/// Triangular [W | z] of `columns` of `R` and of the priors' rows, columns + 1 wide; `xi` is where
/// the right side of the priors is taken, which is zero without `pull`.
Eigen::MatrixXd triangle_with_priors(const Equations& equations, const Prior& prior,
                                     const std::vector<int>& columns, const Eigen::MatrixXd& R,
                                     const Eigen::VectorXd& xi, bool pull);

/// 1 / sigma of the prior of a column: of own freedoms a hundred metres or radians, which only
/// keeps the system regular where a set has too few rows.
double prior_weight(const Equations& equations, const Prior& prior, int column);

/// Squares of the moves of the robot's own parameters over the maker's tolerances, and how many of
/// these directions the rows determine.
struct Chi2 {
  double value = 0, freedom = 0;
};

/// `variance` of the parameters is that of their posterior with `prior`.
Chi2 prior_chi2(const Robot& robot, const Prior& prior, const Eigen::VectorXd& xi,
                const Eigen::VectorXd& variance);
/// The factor on the tolerances that makes it one a degree of freedom where it is beyond 99 %; 1
/// where it is not.
double widening(const Chi2& chi2);

}  // namespace selfcal
