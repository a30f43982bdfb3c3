// The linear equations of a diagnosis: what the geometry, with its priors, and the causes make of
// the rows.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// What the rows say, before any cause: equations x unknowns, whitened.
struct Whitened {
  Eigen::MatrixXd A;       ///< equations x geometry and nuisance parameters
  Eigen::VectorXd weight;  ///< by column of A: 1 / sigma of its prior, 0 without
  Eigen::VectorXd pull;    ///< by column of A: weight times (centre - value)
  Eigen::MatrixXd C;       ///< equations x effects' parameters
  Eigen::VectorXd y;       ///< equations
  double least = 0;        ///< variance of the noise, at least: what a data sheet says of it
};

/// Columns that are no cause: free parameters of the geometry, then the sets' nuisance parameters.
struct Nuisance {
  std::vector<int> columns;      ///< among those of the equations
  Eigen::VectorXd weight, pull;  ///< as in Whitened
};
/// Of a fit of the geometry, for equations with so many columns of `robot` parameters (the
/// geometry's first) and in `all`.
Nuisance nuisance(const Adjusted& adjusted, Eigen::Index robot, Eigen::Index all);

/// `A` over the priors' diagonal.
Eigen::MatrixXd over_priors(const Eigen::MatrixXd& A, const Eigen::VectorXd& weight);

/// The unknowns of A, then those of the columns `causes` of C, that meet `rows` and the priors
/// best. `sigma`: prior of each cause, infinite without one, 0 where it is held at zero.
Eigen::VectorXd best_fit(const Whitened& rows, const std::vector<int>& causes,
                         const Eigen::VectorXd& sigma);

/// What the geometry and the columns `causes` of C leave of `every`, fitted to `some` (the same
/// columns); `sigma` as for best_fit.
Eigen::VectorXd left_of(const Whitened& every, const Whitened& some, const std::vector<int>& causes,
                        const Eigen::VectorXd& sigma);

}  // namespace selfcal
