// What a frame's parameters are called and where they put it in the one before.
#include <array>

#include "kinematics/robots/serial.h"
#include "kinematics/rotation.h"

namespace selfcal::serial {

std::span<const char* const> field_names(bool whole) {
  static constexpr std::array<const char*, kFields> kNumbers = {"alpha", "d", "theta", "r", "beta"};
  static constexpr std::array<const char*, kPoseFields> kPose = {"x", "y", "z", "rx", "ry", "rz"};
  if (whole) return kPose;
  return kNumbers;
}

bool is_angle(const Frame& frame, int field) {
  if (frame.whole) return field >= kRx;
  return field == kAlpha || field == kTheta || field == kBeta;
}

void set_values(Frame& frame, const Eigen::VectorXd& values) {
  if (frame.whole && values.tail<3>() != frame.value.tail<3>()) {
    const Eigen::Vector3d phi = values.tail<3>();
    frame.rpy = phi.isZero(0) ? frame.rpy_nominal
                              : rpy_of(rpy_rotation(frame.rpy_nominal) * exp_rotation(phi));
  }
  frame.value = values;
}

Eigen::Isometry3d pose_in_parent(const Frame& frame, double variable) {
  const Eigen::VectorXd& v = frame.value;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (frame.whole) {
    T.translation() = v.head<3>();
    T.linear() = rpy_rotation(frame.rpy_nominal) * exp_rotation(v.tail<3>());
    return T;
  }
  T.rotate(Eigen::AngleAxisd(v[kBeta], Eigen::Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(v[kAlpha], Eigen::Vector3d::UnitX()));
  T.translate(Eigen::Vector3d(v[kD], 0, 0));
  T.rotate(Eigen::AngleAxisd(v[kTheta] + (frame.motion == Motion::revolute ? variable : 0),
                             Eigen::Vector3d::UnitZ()));
  T.translate(Eigen::Vector3d(0, 0, v[kR] + (frame.motion == Motion::prismatic ? variable : 0)));
  return T;
}

}  // namespace selfcal::serial
