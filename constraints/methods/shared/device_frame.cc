// The device's pose: registration by Kabsch (singular value decomposition of the cross covariance).
#include "constraints/methods/shared/device_frame.h"

#include "kinematics/rotation.h"

namespace selfcal {

Eigen::VectorXd to_values(const Location& X) {
  const Eigen::Quaterniond q(X.R);
  Eigen::VectorXd values(DeviceFrame::kValues);
  values << X.p, q.w(), q.x(), q.y(), q.z();
  return values;
}

Eigen::VectorXd DeviceFrame::world() { return to_values({}); }

Location DeviceFrame::pose(const Eigen::VectorXd& v) {
  return {Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized().toRotationMatrix(), v.head<3>()};
}

void DeviceFrame::retract(Eigen::Ref<Eigen::VectorXd> values, const Eigen::VectorXd& step) {
  Location X = pose(values);
  X.p += step.head<3>();
  X.R = exp_rotation(step.segment<3>(3)) * X.R;
  values.head<kValues>() = to_values(X);
}

std::vector<NuisanceReport> DeviceFrame::report(const Eigen::VectorXd& values, int freedom) {
  static constexpr const char* kNames[] = {"frame.x",  "frame.y",  "frame.z",
                                           "frame.rx", "frame.ry", "frame.rz"};
  const Location X = pose(values);
  const Eigen::Vector3d phi = log_rotation(X.R);
  const Eigen::Matrix3d J = left_jacobian_inverse(phi);
  std::vector<NuisanceReport> list;
  for (int i = 0; i < kFreedom; ++i) {
    NuisanceReport each{kNames[i], i < 3 ? X.p[i] : phi[i - 3], Eigen::VectorXd::Zero(freedom), {}};
    if (i < 3)
      each.D_own[i] = 1;
    else
      each.D_own.segment<3>(3) = J.row(i - 3).transpose();
    list.push_back(std::move(each));
  }
  return list;
}

Eigen::VectorXd DeviceFrame::register_points(const std::vector<Eigen::Vector3d>& device,
                                             const std::vector<Eigen::Vector3d>& world) {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  const double n = static_cast<double>(device.size());
  for (size_t i = 0; i < device.size(); ++i) {
    a += device[i] / n;
    b += world[i] / n;
  }
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < device.size(); ++i) H += (world[i] - b) * (device[i] - a).transpose();
  Location X;
  X.R = nearest_rotation(H);
  X.p = b - X.R * a;
  return to_values(X);
}

}  // namespace selfcal
