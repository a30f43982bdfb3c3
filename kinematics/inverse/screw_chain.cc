#include "kinematics/inverse/screw_chain.h"

#include <cmath>

#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kSameChain = 1e-9;  // of its size; rad, between the screws and the robot itself
constexpr int kChainTrials = 3;      // readings at which they are compared

/// Readings all over the range, the same each time.
Eigen::VectorXd trial_readings(const Robot& robot, int trial) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = 0.4 * robot.joints()[static_cast<std::size_t>(j)].range() *
           std::sin(1.0 + 2.3 * static_cast<double>(j) + 3.1 * trial);
  return q;
}

bool same_machine(const Robot& robot, const Eigen::VectorXd& xi, const ScrewChain& chain) {
  const double length = kSameChain * size_of(robot);
  for (int trial = 0; trial < kChainTrials; ++trial) {
    const Eigen::VectorXd q = trial_readings(robot, trial);
    std::array<double, ScrewChain::kMostJoints> t{};
    for (int j = 0; j < chain.joints; ++j) t[j] = chain.screw[j].gear * q[j];
    const Location is = locate(robot, xi, q), has = chain.at(t.data());
    if ((is.p - has.p).norm() > length || (is.R - has.R).norm() > kSameChain) return false;
  }
  return true;
}

}  // namespace

Location inverse_of(const Location& X) { return {X.R.transpose(), -X.R.transpose() * X.p}; }

Location moved_by(const Screw& screw, double t) {
  if (!screw.turns) return {Eigen::Matrix3d::Identity(), t * screw.axis};
  const Eigen::Matrix3d R = exp_rotation(t * screw.axis);
  return {R, screw.point - R * screw.point};
}

Location ScrewChain::at(const double* t) const {
  Location X;
  for (int j = 0; j < joints; ++j) X = X * moved_by(screw[j], t[j]);
  return X * zero;
}

std::optional<ScrewChain> screw_chain(const Robot& robot, const Eigen::VectorXd& xi) {
  ScrewChain chain;
  if (robot.has_loops() || robot.joints().size() > ScrewChain::kMostJoints) return std::nullopt;
  chain.joints = static_cast<int>(robot.joints().size());
  const ConfigurationBlock block = block_of(Eigen::VectorXd::Zero(chain.joints));
  Locations X;
  PsiBlock psi;
  Eigen::MatrixXd J;
  robot.locate(block, xi, Body::endpoint, X, &psi);
  robot.joint_jacobian(block, xi, Body::endpoint, psi, J);
  chain.zero = X.at(0);
  for (int j = 0; j < chain.joints; ++j) {
    Eigen::Vector3d v, w;
    for (int c = 0; c < 3; ++c) {
      v[c] = J(c, j);
      w[c] = J(3 + c, j);
    }
    Screw& screw = chain.screw[j];
    screw.turns = robot.joints()[static_cast<std::size_t>(j)].quantity == Quantity::angle;
    screw.gear = screw.turns ? w.norm() : v.norm();
    if (!(screw.gear > 0)) return std::nullopt;
    screw.axis = (screw.turns ? w : v) / screw.gear;
    // The point of the line that is nearest to the endpoint: v = w x (p - point).
    if (screw.turns) screw.point = chain.zero.p + w.cross(v) / w.squaredNorm();
  }
  if (!same_machine(robot, xi, chain)) return std::nullopt;
  return chain;
}

}  // namespace selfcal
