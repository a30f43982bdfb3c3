// A robot smaller by a share, with all that it touches, leaves that share less of every touch, so
// that the pull of n touches on the size is their squares, some n, whatever the size is. With f how
// the unknowns follow the given lengths, each made longer by one share, H the posterior's precision
// and p the share by which the robot grows with f, the least squares are off by
//   -e f,   e = p |Delta Y|^2 / (f^T H f),   Delta Y of the lengths:
// of its sigmas n times what the size is known to, which many touches and a coarse length make
// several. How the scatter acts in other directions hangs on how each touch was approached.
#include "constraints/estimation/shrinkage.h"

#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// Every set of rows touches; a length is given of one.
bool lengths_carry_the_scale(const Equations& equations) {
  const auto& sets = equations.data().sets;
  for (int s = 0; s < static_cast<int>(sets.size()); ++s)
    if (!equations.plan(s).items.empty() &&
        !sets[static_cast<std::size_t>(s)].method->may_leave_scale_free())
      return false;
  return equations.known_lengths() > 0;
}

/// What the rows say when every given length is longer by one share of itself.
Eigen::VectorXd longer(const Equations& equations, const Eigen::MatrixXd& R) {
  const Eigen::Index first = R.cols() - 1 - equations.known_lengths();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(R.rows());
  const auto& sets = equations.data().sets;
  for (int s = 0; s < static_cast<int>(sets.size()); ++s) {
    if (equations.plan(s).items.empty()) continue;
    Eigen::Index at = first + equations.known_at(s);
    for (const KnownLength& each : sets[static_cast<std::size_t>(s)].method->known_lengths())
      sum += each.value * R.col(at++);
  }
  return sum;
}

/// Weighed squares of what is left of the lengths; angles are no smaller of a smaller robot.
double squares_of_lengths(const Equations& equations, const State& state, Weighting weighting) {
  for (Scale& each : weighting.scale) each.angle = HUGE_VAL;
  return equations.linearise(state, weighting).R.rightCols(1).squaredNorm();
}

}  // namespace

double growth(const Robot& robot, const std::vector<char>& free, const Eigen::VectorXd& step) {
  const auto& parameters = robot.parameters();
  double change = 0, squares = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    if (!p.link_length || !free[i]) continue;
    change += p.nominal * step[static_cast<Eigen::Index>(i)] / std::pow(p.tolerance, 2);
    squares += std::pow(p.nominal / p.tolerance, 2);
  }
  return squares > 0 ? change / squares : 0;
}

Fit without_shrinkage(const Equations& equations, const Prior& prior, Fit fitted) {
  if (!fitted.converged || !lengths_carry_the_scale(equations)) return fitted;
  const Weighting weighting{fitted.noise.used, fitted.noise.outlier};
  const Eigen::MatrixXd R = equations.linearise(fitted.state, weighting, true).R;
  const auto W = R.leftCols(equations.columns());
  const Eigen::VectorXd f = fitted.covariance * (W.transpose() * longer(equations, R));
  const double precision =
      (W * f).squaredNorm() + f.dot(prior_precision(equations, prior).cwiseProduct(f));
  if (!(precision > 0)) return fitted;
  const double e = growth(equations.robot(), prior.free, f) *
                   squares_of_lengths(equations, fitted.state, weighting) / precision;
  fitted.state = equations.stepped(fitted.state, fitted.at, e * f);
  fitted.at = equations.linearise(fitted.state, weighting);
  fitted.at.norms = {};
  return fitted;
}

}  // namespace selfcal
