// From the fit to what the user is told: each parameter, each set, each warning.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "constraints/estimation/adjustment.h"
#include "constraints/estimation/judgement.h"
#include "constraints/fitting/fit.h"
#include "constraints/identifiability/identifiability.h"
#include "constraints/solution.h"

namespace selfcal {

/// `C` is the posterior of all columns, `candidate` tells what is not fixed, `free` what is not
/// held either.
std::vector<ParameterResult> parameter_results(const Robot& robot, const Eigen::VectorXd& xi,
                                               const Eigen::MatrixXd& C,
                                               const Identifiability& rank,
                                               const std::vector<char>& candidate,
                                               const std::vector<char>& free);

/// Names and covariance of the parameters that have a sigma.
std::pair<std::vector<std::string>, Eigen::MatrixXd> covariance_result(
    const std::vector<ParameterResult>& parameters, const Eigen::MatrixXd& C);

Observability identified_observability(const Equations& equations, const Eigen::MatrixXd& R,
                                       const Identifiability& rank, const Noise& noise);

std::vector<SetResult> set_results(const Equations& equations, const Fit& fit,
                                   const Eigen::MatrixXd& C, const Judged& after);

/// Priors widened, parameters moved far, an orientation that imitates an offset, noise far above
/// the data sheet's or the repeats', rows put aside up to the bound.
void add_warnings(const Equations& equations, const Adjusted& adjusted, Solution& solution);

/// The box is reached by fewer `poses` than are `wanted`, so that it, its frame or its cone may be
/// wrong; empty where it is not.
std::string hardly_reached(const Workspace& workspace, Eigen::Index poses, int wanted);

/// Why nobody knows how sure the result is; empty where the noise is stated, or rows enough tell
/// it.
std::string untold_noise(const Equations& equations, const Adjusted& adjusted);

/// By how much the robot is elsewhere than any geometry says, in each direction measured (m): what
/// the rows of a set that identify scatter beside their repeats or their data sheet's noise, of the
/// set with most of it; 0 where they scatter no more.
double strays(const Equations& equations, const std::vector<SetResult>& sets);

}  // namespace selfcal
