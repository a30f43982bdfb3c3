// Rows of one group share the endpoint's whole location, an unknown pose C (11.48 to 11.50, here
// against the shared pose rather than row against row, so that groups may have any size):
//   r_p = P - p_C,   r_R = log(R R_C^T)
//   dr_p = dP - dp_C,  dr_R = Jl^-1(r_R) delta - Jr^-1(r_R) dphi_C
#include "constraints/methods/maker.h"
#include "constraints/methods/shared/device_frame.h"
#include "constraints/statistics.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

class LocationConstraint final : public Method {
 public:
  std::string_view name() const override { return "location-constraint"; }
  std::vector<Quantity> equations() const override {
    return {Quantity::length, Quantity::length, Quantity::length,
            Quantity::angle,  Quantity::angle,  Quantity::angle};
  }
  std::vector<std::string> columns() const override { return {"group"}; }
  Planned planned() const override { return Planned::places; }
  bool vectors() const override { return true; }
  bool may_leave_scale_free() const override { return true; }
  int group_freedom() const override { return DeviceFrame::kFreedom; }
  std::vector<std::string> group_names() const override { return {"x", "y", "z"}; }

  Eigen::VectorXd start_group(const std::vector<Location>& X) const override {
    Location mean;
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    const Eigen::Quaterniond first(X.front().R);
    for (const Location& each : X) {
      const Eigen::Quaterniond turned(each.R);
      q += turned.dot(first) < 0 ? -turned.coeffs() : turned.coeffs();
    }
    mean.R = Eigen::Quaterniond(Eigen::Vector4d(q.normalized())).toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      std::vector<double> v;
      for (const Location& each : X) v.push_back(each.p[i]);
      mean.p[i] = median(std::move(v));
    }
    return to_values(mean);
  }
  void retract_group(Eigen::Ref<Eigen::VectorXd> group,
                     const Eigen::VectorXd& step) const override {
    DeviceFrame::retract(group, step);
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    constexpr int g = DeviceFrame::kFreedom;
    for (int lane = 0; lane < in.count; ++lane) {
      const Location C = DeviceFrame::pose(in.groups->col(in.data->group[in.rows[lane]]));
      const Eigen::Vector3d phi = log_rotation(in.now->R(lane) * C.R.transpose());
      const Eigen::Matrix3d Jl = left_jacobian_inverse(phi);  // Jr^-1 is its transpose
      out.r.row(lane).head<3>() = (in.now->p(lane) - C.p).transpose();
      out.r.row(lane).tail<3>() = phi.transpose();
      for (int a = 0; a < 3; ++a) {
        set_linear(out.G_now, lane, a, Eigen::Vector3d::Unit(a));
        set_angular(out.G_now, lane, 3 + a, Jl.row(a));
        out.D_group.row(lane).segment<3>(a * g) = -Eigen::RowVector3d::Unit(a);
        out.D_group.row(lane).segment<3>((3 + a) * g + 3) = -Jl.col(a).transpose();
      }
    }
  }
};

}  // namespace

MethodPtr make_location_constraint(SetEntry&) { return std::make_unique<LocationConstraint>(); }

}  // namespace selfcal
