// Rows of one group share the endpoint's whole location, an unknown pose C (11.48 to 11.50, here
// against the shared pose rather than row against row, so that groups may have any size):
//   r_p = R^T (P - p_C),   r_R = log(R_C^T R)
//   dr_p = R^T (dP + [P - p_C]x delta - dp_C),  dr_R = Jr^-1(r_R) R^T delta - Jl^-1(r_R) R_C^T
//   dphi_C
// in the tool's axes, so that a turn of the world leaves r exactly alone.
#include "constraints/methods/device_frame.h"
#include "constraints/methods/maker.h"
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
  bool may_leave_scale_free() const override { return true; }
  int group_freedom() const override { return DeviceFrame::kFreedom; }
  std::vector<std::string> group_names() const override { return {"x", "y", "z"}; }

  Eigen::VectorXd start_group(const std::vector<Location>& X) const override {
    return to_values(X[X.size() / 2]);
  }
  void retract_group(Eigen::Ref<Eigen::VectorXd> group,
                     const Eigen::VectorXd& step) const override {
    DeviceFrame::retract(group, step);
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    constexpr int g = DeviceFrame::kFreedom;
    for (int lane = 0; lane < in.count; ++lane) {
      const Location C = DeviceFrame::pose(in.groups->col(in.data->group[in.rows[lane]]));
      const Eigen::Vector3d miss = in.now->p(lane) - C.p;
      const Eigen::Matrix3d to_tool = in.now->R(lane).transpose();
      const Eigen::Vector3d phi = log_rotation(C.R.transpose() * in.now->R(lane));
      const Eigen::Matrix3d Jl = left_jacobian_inverse(phi);
      const Eigen::Matrix3d p_by_turn = to_tool * skew(miss), R_by_turn = Jl.transpose() * to_tool;
      const Eigen::Matrix3d R_by_group = Jl * C.R.transpose();
      out.r.row(lane).head<3>() = (to_tool * miss).transpose();
      out.r.row(lane).tail<3>() = phi.transpose();
      for (int a = 0; a < 3; ++a) {
        set_linear(out.G_now, lane, a, to_tool.row(a));
        set_angular(out.G_now, lane, a, p_by_turn.row(a));
        set_angular(out.G_now, lane, 3 + a, R_by_turn.row(a));
        out.D_group.row(lane).segment<3>(a * g) = -to_tool.row(a);
        out.D_group.row(lane).segment<3>((3 + a) * g + 3) = -R_by_group.row(a);
      }
    }
  }
};

}  // namespace

MethodPtr make_location_constraint(SetEntry&) { return std::make_unique<LocationConstraint>(); }

}  // namespace selfcal
