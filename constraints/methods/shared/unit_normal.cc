// Unit normals: tangents, retraction, total least squares.
#include "constraints/methods/shared/unit_normal.h"

#include "kinematics/linear_algebra.h"

namespace selfcal {

Eigen::Matrix<double, 3, 2> tangents(const Eigen::Vector3d& n) {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Eigen::Matrix<double, 3, 2> T;
  T.col(0) = n.cross(Eigen::Vector3d(Eigen::Vector3d::Unit(least))).normalized();
  T.col(1) = n.cross(Eigen::Vector3d(T.col(0)));
  return T;
}

Eigen::Vector3d tilted(const Eigen::Vector3d& n, const Eigen::Vector2d& step) {
  return (n + tangents(n) * step).normalized();
}

Eigen::Vector3d best_normal(const std::vector<Location>& X) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Location& each : X) mean += each.p / static_cast<double>(X.size());
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Location& each : X) moment += (each.p - mean) * (each.p - mean).transpose();
  return symmetric_eigen(moment).vectors.col(0);
}

Eigen::Vector3d random_direction(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

}  // namespace selfcal
