// With C0 the posterior of the free unknowns and Lambda the precision of their priors
//   C0 = (C0 - C0 Lambda C0) + C0 Lambda C0,
// the first of the rows' noise, the second of the priors; the others come on top. The rows' part is
// that of each set, C0 R_s^T R_s C0, a share of it the encoders' rounding, another what repeats
// differ by beside that.
#include "constraints/estimation/covariance_sources.h"

#include <algorithm>
#include <cmath>

#include "constraints/equations/resolution.h"
#include "constraints/estimation/half_samples.h"
#include "constraints/estimation/posterior.h"
#include "constraints/fitting/noise.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/solution.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// Halves of rows with independent noise differ by up to so much more than is expected.
constexpr double kChance = 1.5;

Eigen::MatrixXd prior_part(const Equations& equations, const Adjusted& adjusted) {
  const Eigen::MatrixXd& C = adjusted.fitted.covariance;
  return transposed_product(C, prior_precision(equations, adjusted.prior).asDiagonal() * C);
}

/// The noise of the rows by where it comes from; `all` is what they add up to.
std::vector<CovarianceSource> noise_parts(const Equations& equations, const Adjusted& adjusted,
                                          const Eigen::MatrixXd& all) {
  const Fit& fitted = adjusted.fitted;
  const std::vector<double> rounding =
      resolution_shares(equations, fitted.state, fitted.noise.used, fitted.noise.outlier);
  const Observations& rows = equations.data().rows;
  const std::vector<RowResidual> residuals =
      rows.repeat.empty() ? std::vector<RowResidual>() : equations.residuals(fitted.state);
  Eigen::MatrixXd encoders = Eigen::MatrixXd::Zero(all.rows(), all.cols()), repeats = encoders;
  for (int s = 0; s < static_cast<int>(rounding.size()); ++s) {
    if (equations.plan(s).items.empty()) continue;
    const double spread =
        std::max(0.0, repeat_sigma(equations.data(), s, residuals, fitted.noise.outlier));
    const double coarse = std::min(1.0, rounding[s]);
    const double repeated =
        std::clamp(std::pow(spread / fitted.noise.used[s].length, 2) - coarse, 0.0, 1 - coarse);
    if (coarse + repeated == 0) continue;
    Weighting alone{fitted.noise.used, fitted.noise.outlier};
    alone.passed_over = true;
    for (int row = 0; row < rows.rows(); ++row)
      if (rows.set[static_cast<size_t>(row)] != s) alone.outlier[static_cast<size_t>(row)] = 1;
    const Eigen::MatrixXd R = equations.linearise(fitted.state, alone).R;
    const Eigen::MatrixXd half =
        R.leftCols(equations.columns()) * fitted.covariance.topLeftCorner(all.rows(), all.cols());
    const Eigen::MatrixXd of_set = transposed_product(half, half);
    encoders += coarse * of_set;
    repeats += repeated * of_set;
  }
  return {{kNoiseOfRows, all - encoders - repeats},
          {"resolution of the encoders", encoders},
          {"repeatability, from repeats", repeats}};
}

/// The end position's, of a covariance whose first columns are the robot's parameters (m^2).
double squared(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C) {
  return std::pow(endpoint_rms(weight, C.topLeftCorner(weight.rows(), weight.cols())), 2);
}

/// What halves of the rows differ by more than they should.
Eigen::MatrixXd shared_errors(const Equations& equations, const Adjusted& adjusted,
                              const Eigen::MatrixXd& weight) {
  const HalfSamples halves = half_samples(equations, adjusted);
  const double seen = squared(weight, halves.seen), expected = squared(weight, halves.expected);
  return std::max(0.0, 1 - kChance * expected / seen) * halves.seen;
}

}  // namespace

std::vector<CovarianceSource> covariance_sources(const Equations& equations,
                                                 const Adjusted& adjusted, const Eigen::MatrixXd& R,
                                                 const Eigen::MatrixXd& weight) {
  const Eigen::MatrixXd& fitted = adjusted.fitted.covariance;
  const Eigen::MatrixXd priors = prior_part(equations, adjusted), noise = fitted - priors;
  const Eigen::MatrixXd exact =
      adjusted.scale < 0 ? fitted : posterior(equations, adjusted, R, false);
  std::vector<CovarianceSource> sources = noise_parts(equations, adjusted, noise);
  sources.push_back({"the maker's tolerances", priors});
  sources.push_back({"held scale", exact - fitted});
  Eigen::MatrixXd shared = shared_errors(equations, adjusted, weight);
  const double structure = 1 + squared(weight, shared) / squared(weight, noise);
  sources.push_back({"what was given", posterior(equations, adjusted, R, true, structure) - exact});
  sources.push_back({kSharedErrors, std::move(shared)});
  return sources;
}

Eigen::MatrixXd sum(const std::vector<CovarianceSource>& sources) {
  Eigen::MatrixXd C = sources.front().C;
  for (size_t i = 1; i < sources.size(); ++i) C += sources[i].C;
  return C;
}

}  // namespace selfcal
