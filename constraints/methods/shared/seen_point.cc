// With w = R_F a: dr = w . (dP - dp_F) + (w x (P - p_F)) . dphi_F, and of an unknown point
// w . dP = w . dp_L + (R_L s x w) . dphi_L + (R_L^T w) . ds.
#include "constraints/methods/shared/seen_point.h"

#include "constraints/methods/maker.h"

namespace selfcal {

Eigen::VectorXd SeenPoint::start(const Location& tool) const {
  Eigen::VectorXd values(kValues);
  values << DeviceFrame::world(), tool.p;
  return values;
}

void SeenPoint::retract(Eigen::VectorXd& values, const Eigen::VectorXd& step) const {
  if (frame_) DeviceFrame::retract(values.head<DeviceFrame::kValues>(), step);
  if (point_) values.tail<3>() += step.tail<3>();
}

std::vector<NuisanceReport> SeenPoint::report(const Eigen::VectorXd& values) const {
  std::vector<NuisanceReport> list;
  if (frame_) list = DeviceFrame::report(values, freedom());
  static constexpr const char* kNames[] = {"point.x", "point.y", "point.z"};
  for (int i = 0; point_ && i < 3; ++i) {
    NuisanceReport each{
        kNames[i], values[DeviceFrame::kValues + i], Eigen::VectorXd::Zero(freedom()), {}};
    each.D_own[point_at() + i] = 1;
    list.push_back(std::move(each));
  }
  return list;
}

Eigen::VectorXd SeenPoint::random(Random& random) const {
  std::normal_distribution<double> normal;
  Eigen::VectorXd values(kValues);
  values << DeviceFrame::world(), 0.05, 0.02, 0.1;
  if (frame_) {
    Eigen::VectorXd step(DeviceFrame::kFreedom);
    for (double& v : step) v = normal(random);
    DeviceFrame::retract(values.head<DeviceFrame::kValues>(), step);
  }
  return values;
}

void SeenPoint::chain(const Eigen::Vector3d& a, const Location& F, const Eigen::VectorXd& values,
                      const Location& X, int lane, int equation, MethodOutput& out) const {
  const Eigen::Vector3d w = F.R * a;
  const int own = equation * freedom();
  set_linear(out.G_now, lane, equation, w);
  if (frame_) {
    out.D_own.row(lane).segment<3>(own) = -w.transpose();
    out.D_own.row(lane).segment<3>(own + 3) = w.cross(place(X, values) - F.p).transpose();
  }
  if (!point_) return;
  set_angular(out.G_now, lane, equation, (X.R * values.tail<3>()).cross(w));
  out.D_own.row(lane).segment<3>(own + point_at()) = (X.R.transpose() * w).transpose();
}

}  // namespace selfcal
