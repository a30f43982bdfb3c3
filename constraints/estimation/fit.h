// The iteration: Gauss-Newton on streamed R with Levenberg-Marquardt behind it, Huber weights,
// noise and rows put aside re-estimated whenever the geometry has settled.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/estimation/noise.h"

namespace selfcal {

/// Gaussian priors of the robot's parameters; those that are not free stay where they are.
struct Prior {
  Eigen::VectorXd centre, sigma;
  std::vector<char> free;
  bool use = true;  ///< false: no prior on free parameters
};

struct FitRule {
  int most_iterations = 100;
  double most_outliers = 0;      ///< as NoiseRule's
  double step_tolerance = 1e-5;  ///< of the whitened step: a hundred-thousandth of a sigma
  bool near = false;             ///< it starts where a fit of a part of the rows ended
  bool unmask = false;           ///< looks for outliers that bend the fit to themselves
};

struct Fit {
  State state;
  Noise noise;
  Linearised at;               ///< at `state`, without the rows' norms
  Eigen::MatrixXd covariance;  ///< of columns(): posterior; zero rows for what is not free
  double objective = 0;   ///< -2 log posterior up to a constant: compares fits of the same rows
  std::vector<int> rows;  ///< by set, that gave an equation
  int iterations = 0;
  bool converged = false;
  std::string stop_reason;
};

/// Called after every iteration with its number.
using OnIteration = std::function<void(int)>;

Fit fit(const Equations& equations, const State& start, const Prior& prior, const FitRule& rule,
        const OnIteration& on_iteration = {});

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

}  // namespace selfcal
