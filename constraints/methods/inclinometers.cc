// Two inclinometers on the tool (Besnard and Khalil, Calibration of parallel robots using two
// inclinometers): how the vertical v, the world's z, stands in the tool's frame, v = R^T z. They
// are roll and pitch of the tool, R = Rot(z, heading) Rot(y, beta) Rot(x, alpha):
//   r = (atan2(v_y, v_z) - alpha, atan2(-v_x, |v_y, v_z|) - beta),   dv = R^T (z x turn)
// The heading about the vertical is not seen.
#include <cmath>

#include "constraints/methods/maker.h"

namespace selfcal {
namespace {

class Inclinometers final : public Method {
 public:
  std::string_view name() const override { return "inclinometers"; }
  std::vector<Quantity> equations() const override { return {2, Quantity::angle}; }
  std::vector<MeasuredColumn> measures() const override {
    return {{"alpha", Quantity::angle}, {"beta", Quantity::angle}};
  }
  bool constrains() const override { return false; }
  bool sees_point() const override { return false; }
  bool may_leave_scale_free() const override { return true; }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::VectorXd &alpha = in.data->column("alpha"), &beta = in.data->column("beta");
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Matrix3d R = in.now->R(lane);
      const Eigen::Vector3d v = R.transpose() * z;
      const Eigen::Vector2d now = angles(v);
      out.r(lane, 0) = wrapped(now[0] - alpha[in.rows[lane]]);
      out.r(lane, 1) = wrapped(now[1] - beta[in.rows[lane]]);
      const double across = std::hypot(v.y(), v.z());
      const Eigen::Vector3d roll(0, v.z() / (across * across), -v.y() / (across * across));
      const Eigen::Vector3d pitch(-across, v.x() * v.y() / across, v.x() * v.z() / across);
      set_angular(out.G_now, lane, 0, (R * roll).cross(z));
      set_angular(out.G_now, lane, 1, (R * pitch).cross(z));
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd&, Observations& data,
               int row) const override {
    const Eigen::Vector2d now = angles(X.R.transpose() * Eigen::Vector3d::UnitZ());
    data.column("alpha")[row] = now[0];
    data.column("beta")[row] = now[1];
  }

 private:
  static Eigen::Vector2d angles(const Eigen::Vector3d& v) {
    return {std::atan2(v.y(), v.z()), std::atan2(-v.x(), std::hypot(v.y(), v.z()))};
  }
};

}  // namespace

MethodPtr make_inclinometers(SetEntry&) { return std::make_unique<Inclinometers>(); }

}  // namespace selfcal
