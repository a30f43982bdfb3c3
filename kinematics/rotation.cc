// Rotation vectors. Jl^-1 = I - [phi]x / 2 + (1/t^2 - 1 / (2 t tan(t/2))) [phi]x^2, t = |phi|.
#include "kinematics/rotation.h"

#include <cmath>

namespace selfcal {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d exp_rotation(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, phi / angle).toRotationMatrix();
}

Eigen::Vector3d log_rotation(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2 * q.vec();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double t = phi.norm();
  const Eigen::Matrix3d S = skew(phi);
  // The coefficient of S^2 by its series below 0.01 rad, where the closed form loses digits:
  // 1/12 + t^2/720 leaves t^4/30240 < 1e-12.
  const double c = t < 1e-2 ? 1.0 / 12 + t * t / 720 : 1 / (t * t) - 1 / (2 * t * std::tan(t / 2));
  return Eigen::Matrix3d::Identity() - 0.5 * S + c * S * S;
}

}  // namespace selfcal
