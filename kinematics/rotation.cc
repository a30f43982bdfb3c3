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

Eigen::Matrix3d turn_onto(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double cosine = a.dot(b);
  Eigen::Vector3d n = a.cross(b);
  if (cosine < 0) {  // a half turn about the same axis, and from there back
    constexpr double kNoAxis = 1e-12;
    if (n.norm() < kNoAxis) n = a.cross(Eigen::Vector3d::Unit(std::abs(a.y()) < 0.9 ? 1 : 0));
    n = (n - a.dot(n) * a).normalized();
    const Eigen::Matrix3d half = 2 * n * n.transpose() - Eigen::Matrix3d::Identity();
    return turn_onto(-a, b) * half;
  }
  const Eigen::Matrix3d K = skew(n);
  return Eigen::Matrix3d::Identity() + K + K * K / (1 + cosine);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3d rpy_rotation(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Matrix3d rotation_of(std::string_view axes, const Eigen::Vector3d& angles) {
  if (axes.empty()) return exp_rotation(angles);
  const bool fixed = axes[0] >= 'a';
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(axes[i] - (fixed ? 'x' : 'X'));
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angles[i], axis).toRotationMatrix();
    R = fixed ? Eigen::Matrix3d(turn * R) : Eigen::Matrix3d(R * turn);
  }
  return R;
}

Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R) {
  // Where the pitch is a quarter turn, yaw and roll turn about one axis and each alone is rounding;
  // the roll is therefore that of Rot(z, -yaw) R, for whatever yaw was taken.
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

}  // namespace selfcal
