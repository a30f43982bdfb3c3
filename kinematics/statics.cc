#include "kinematics/statics.h"

namespace selfcal {
namespace {

/// Moves what is known of a body's origin to its point `at`: dp += dphi x R at.
void move_to(const Eigen::Vector3d& at, Locations& X, PsiBlock* psi) {
  const Eigen::Index lanes = X.position.rows();
  for (int lane = 0; lane < lanes; ++lane) {
    const Eigen::Vector3d arm = X.R(lane) * at;
    X.position.row(lane) += arm.transpose().array();
    if (!psi) continue;
    const auto row = [&](int c) { return psi->row(c * lanes + lane); };
    row(0) += row(4) * arm.z() - row(5) * arm.y();
    row(1) += row(5) * arm.x() - row(3) * arm.z();
    row(2) += row(3) * arm.y() - row(4) * arm.x();
  }
}

}  // namespace

Eigen::Vector3d gravity_of(const Robot& robot) {
  const PointMasses* masses = robot.masses();
  return masses ? masses->gravity : PointMasses().gravity;
}

bool weighs(const Robot& robot) { return robot.masses() && !robot.masses()->points.empty(); }

Closure locate_point(const Robot& robot, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                     Body body, const Eigen::Vector3d& at, Locations& X, PsiBlock* psi) {
  Closure closure = robot.locate(block, xi, body, X, psi);
  move_to(at, X, psi);
  return closure;
}

Eigen::MatrixXd work_of_weights(const Robot& robot, const ConfigurationBlock& block,
                                const Eigen::VectorXd& xi) {
  Eigen::MatrixXd work = Eigen::MatrixXd::Zero(block.q.rows(), xi.size());
  const PointMasses* masses = robot.masses();
  if (!masses) return work;
  Locations X;
  PsiBlock psi;
  for (const PointMass& each : masses->points) {
    locate_point(robot, block, xi, each.body, each.at, X, &psi);
    for (int c = 0; c < 3; ++c)
      work += each.mass * masses->gravity[c] * psi.middleRows(c * work.rows(), work.rows());
  }
  return work;
}

}  // namespace selfcal
