// Poses by Newton steps on the location's six errors; wrenches drawn.
#include "tests/recovery/kamali_plan.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal::recovery {
namespace {

constexpr int kGrid = 5;

double uniform(std::mt19937_64& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

Eigen::Matrix3d random_rotation(std::mt19937_64& random, double most) {
  const Eigen::Vector3d axis =
      Eigen::Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
  return exp_rotation(most * axis);
}

/// Newton steps from a random start within the limits; empty when they lead elsewhere.
Eigen::VectorXd inverse(const Robot& robot, const Eigen::Matrix3d& R, const Eigen::Vector3d& p,
                        std::mt19937_64& random) {
  const std::vector<Joint>& joints = robot.joints();
  Eigen::VectorXd q(static_cast<Eigen::Index>(joints.size()));
  for (size_t j = 0; j < joints.size(); ++j)
    q[static_cast<Eigen::Index>(j)] = uniform(random, joints[j].lower, joints[j].upper) / 2;
  Locations X;
  PsiBlock psi;
  Eigen::MatrixXd J;
  for (int step = 0; step < 60; ++step) {
    robot.locate(block_of(q), values(robot), Body::endpoint, X, &psi);
    Eigen::VectorXd error(6);
    error << p - X.p(0), log_rotation(R * X.R(0).transpose());
    if (error.norm() < 1e-10) break;
    robot.joint_jacobian(block_of(q), values(robot), Body::endpoint, psi, J);
    Eigen::MatrixXd J0(6, q.size());
    for (int c = 0; c < 6; ++c) J0.row(c) = J.row(c);
    const Eigen::VectorXd full = least_squares(J0, error);
    q += full * std::min(1.0, 0.5 / full.norm());
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    const double at = q[static_cast<Eigen::Index>(j)];
    if (at < joints[j].lower || at > joints[j].upper) return {};
  }
  return (X.p(0) - p).norm() < 1e-9 ? q : Eigen::VectorXd();
}

}  // namespace

Eigen::MatrixXd poses_in_the_cube(const Robot& robot, std::mt19937_64& random) {
  const Eigen::Isometry3d base = robot.statics()->link_poses(
      Eigen::VectorXd::Zero(6))[3];  // w4: the robot's base in the tracker's frame
  const Eigen::Vector3d centre(0.95, 0, 0.75);
  // The tool's z along x and 45 degrees down.
  const Eigen::Matrix3d ahead =
      Eigen::AngleAxisd(135 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Eigen::MatrixXd q(kGrid * kGrid * kGrid, 6);
  for (Eigen::Index i = 0; i < q.rows();) {
    const Eigen::Vector3d cell(static_cast<double>(i % kGrid),
                               static_cast<double>(i / kGrid % kGrid),
                               static_cast<double>(i / (kGrid * kGrid)));
    const Eigen::Vector3d p = centre + 0.125 * (cell - Eigen::Vector3d::Constant(2));
    const Eigen::Matrix3d R = ahead * random_rotation(random, 1);
    const Eigen::VectorXd found = inverse(robot, base.linear() * R, base * p, random);
    if (found.size() > 0) q.row(i++) = found.transpose();
  }
  return q;
}

Eigen::MatrixXd random_wrenches(Eigen::Index count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd wrench(count, 6);
  for (Eigen::Index i = 0; i < count; ++i)
    for (const auto& [at, most] : {std::pair(0, 120.0), std::pair(3, 10.0)}) {
      Eigen::Vector3d part(normal(random), normal(random), normal(random));
      part *= most / 2;
      wrench.row(i).segment<3>(at) = part.transpose() * std::min(1.0, most / part.norm());
    }
  return wrench;
}

}  // namespace selfcal::recovery
