// The iteration: Gauss-Newton on streamed R with Levenberg-Marquardt behind it, Huber weights,
// noise and rows put aside re-estimated whenever the geometry has settled.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/fitting/noise.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

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

}  // namespace selfcal
