// Rotation vectors: the exponential, the logarithm and its derivatives, exact for large angles.
//   exp(phi) is the rotation by |phi| about phi; log its inverse, |log| <= pi.
//   log(exp(d) R) = log(R) + Jl^-1 d,  log(R exp(d)) = log(R) + Jr^-1 d,  Jr^-1 = Jl^-T.
// The orientation error of Khalil and Dombre 11.41, 11.42 is such a vector: u alpha = log(A_r
// A_m^T).
#pragma once

#include <Eigen/Dense>
#include <string_view>

namespace selfcal {

Eigen::Matrix3d skew(const Eigen::Vector3d& v);
Eigen::Matrix3d exp_rotation(const Eigen::Vector3d& phi);
Eigen::Vector3d log_rotation(const Eigen::Matrix3d& R);
/// Inverse of the left Jacobian of SO(3) at phi, |phi| < 2 pi.
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);
/// The least turn that brings the direction `a` onto the direction `b`, both of length one.
Eigen::Matrix3d turn_onto(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// The rotation R for which trace(R^T M) is greatest: of M = sum of b a^T the one that brings the
/// vectors a nearest to the vectors b (Kabsch).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

/// Rot(z, yaw) Rot(y, pitch) Rot(x, roll) of [roll, pitch, yaw], in URDF's order.
Eigen::Matrix3d rpy_rotation(const Eigen::Vector3d& rpy);
/// The rotation that three angles (rad) say in the order of `axes`: of small letters, turns about
/// the fixed axes, R = R(axis 3) R(axis 2) R(axis 1); of capitals, turns about the axes that turn
/// along, R = R(axis 1) R(axis 2) R(axis 3); of no letter the exponential of the vector.
Eigen::Matrix3d rotation_of(std::string_view axes, const Eigen::Vector3d& angles);
/// Angles that give R, |pitch| <= pi / 2; to rounding at a pitch of a quarter turn, too.
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R);

}  // namespace selfcal
