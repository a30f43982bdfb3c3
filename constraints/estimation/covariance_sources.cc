// With C0 the posterior of the free unknowns and Lambda the precision of their priors
//   C0 = (C0 - C0 Lambda C0) + C0 Lambda C0,
// the first of the rows' noise, the second of the priors; the others come on top.
#include "constraints/estimation/covariance_sources.h"

#include <algorithm>
#include <cmath>

#include "constraints/estimation/half_samples.h"
#include "constraints/estimation/posterior.h"

namespace selfcal {
namespace {

/// Halves of rows with independent noise differ by up to so much more than is expected.
constexpr double kChance = 1.5;

Eigen::MatrixXd prior_part(const Equations& equations, const Adjusted& adjusted) {
  const Eigen::MatrixXd& C = adjusted.fitted.covariance;
  return C * prior_precision(equations, adjusted.prior).asDiagonal() * C;
}

/// What halves of the rows differ by more than they should.
Eigen::MatrixXd shared_errors(const Equations& equations, const Adjusted& adjusted,
                              EndpointQuestion question) {
  const HalfSamples halves = half_samples(equations, adjusted);
  const auto squared = [&](const Eigen::MatrixXd& C) {
    const Eigen::Index n = equations.robot_columns();
    question.covariance = C.topLeftCorner(n, n);
    return std::pow(endpoint_sigma(question).rms, 2);
  };
  const double seen = squared(halves.seen), expected = squared(halves.expected);
  return std::max(0.0, 1 - kChance * expected / seen) * halves.seen;
}

}  // namespace

std::vector<CovarianceSource> covariance_sources(const Equations& equations,
                                                 const Adjusted& adjusted, const Eigen::MatrixXd& R,
                                                 const EndpointQuestion& question) {
  const Eigen::MatrixXd& fitted = adjusted.fitted.covariance;
  const Eigen::MatrixXd priors = prior_part(equations, adjusted), noise = fitted - priors;
  const Eigen::MatrixXd exact =
      adjusted.scale < 0 ? fitted : posterior(equations, adjusted, R, false);
  return {{"noise of the rows", noise},
          {"the maker's tolerances", priors},
          {"held scale", exact - fitted},
          {"what was given", posterior(equations, adjusted, R, true) - exact},
          {"rows that share errors", shared_errors(equations, adjusted, question)}};
}

Eigen::MatrixXd sum(const std::vector<CovarianceSource>& sources) {
  Eigen::MatrixXd C = sources.front().C;
  for (size_t i = 1; i < sources.size(); ++i) C += sources[i].C;
  return C;
}

}  // namespace selfcal
