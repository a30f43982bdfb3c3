// Measured position of the endpoint (11.5.1, first three equations of 11.39 and 11.45):
//   r = R_F^T (P(q, xi) - p_F) - x,   dr = R_F^T (Psi_p dxi - dp_F + [P - p_F]x dphi_F)
// in the device's axes; its frame F is the world unless `frame: unknown`. With `point: unknown` the
// target is fixed to the last moving link at s: P = p_L + R_L s, dP = dp_L - [R_L s]x dphi_L + R_L
// ds.
#include "constraints/methods/device_frame.h"
#include "constraints/methods/maker.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

class Position final : public Method {
 public:
  Position(bool frame, bool point) : frame_(frame), point_(point) {}

  std::string_view name() const override { return "position"; }
  std::vector<Quantity> equations() const override { return {3, Quantity::length}; }
  std::vector<std::string> columns() const override { return {"x", "y", "z"}; }
  bool constrains() const override { return false; }
  bool frame_unknown() const override { return frame_; }
  bool point_unknown() const override { return point_; }
  int tangent_dimension() const override { return point_at() + (point_ ? 3 : 0); }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location& tool) const override {
    Eigen::VectorXd nuisance(DeviceFrame::kValues + 3);
    nuisance << DeviceFrame::world(), tool.p;
    if (!frame_) return nuisance;
    std::vector<Eigen::Vector3d> device, world;
    for (size_t i = 0; i < rows.size(); ++i) {
      device.emplace_back(data.position.row(rows[i]).transpose());
      world.push_back(point_ ? X[i].p + X[i].R * tool.p : X[i].p);
    }
    nuisance.head<DeviceFrame::kValues>() = DeviceFrame::register_points(device, world);
    return nuisance;
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (frame_) DeviceFrame::retract(nuisance.head<DeviceFrame::kValues>(), step);
    if (point_) nuisance.tail<3>() += step.tail<3>();
  }

  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    std::vector<NuisanceReport> list;
    if (frame_) list = DeviceFrame::report(nuisance, tangent_dimension());
    static constexpr const char* kNames[] = {"point.x", "point.y", "point.z"};
    for (int i = 0; point_ && i < 3; ++i) {
      NuisanceReport each{kNames[i],
                          nuisance[DeviceFrame::kValues + i],
                          Eigen::VectorXd::Zero(tangent_dimension()),
                          {}};
      each.D_own[point_at() + i] = 1;
      list.push_back(std::move(each));
    }
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Location F = DeviceFrame::pose(*in.nuisance);
    const Eigen::Vector3d s =
        point_ ? Eigen::Vector3d(in.nuisance->tail<3>()) : Eigen::Vector3d::Zero();
    const Eigen::Matrix3d to_device = F.R.transpose();
    const int m = tangent_dimension();
    for (int lane = 0; lane < in.count; ++lane) {
      Eigen::Vector3d P = in.now->p(lane);
      Eigen::Matrix3d by_angle = Eigen::Matrix3d::Zero(), by_point = Eigen::Matrix3d::Zero();
      if (point_) {
        const Eigen::Matrix3d R = in.now->R(lane);
        P += R * s;
        by_angle = -to_device * skew(R * s);
        by_point = to_device * R;
      }
      const Eigen::Matrix3d by_turn = to_device * skew(P - F.p);
      out.r.row(lane) = (to_device * (P - F.p)).transpose() - in.data->position.row(in.rows[lane]);
      for (int a = 0; a < 3; ++a) {
        set_linear(out.G_now, lane, a, to_device.row(a));
        if (point_) set_angular(out.G_now, lane, a, by_angle.row(a));
        if (frame_) {
          out.D_own.row(lane).segment<3>(a * m) = -to_device.row(a);
          out.D_own.row(lane).segment<3>(a * m + 3) = by_turn.row(a);
        }
        if (point_) out.D_own.row(lane).segment<3>(a * m + point_at()) = by_point.row(a);
      }
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    const Location F = DeviceFrame::pose(nuisance);
    const Eigen::Vector3d P = point_ ? X.p + X.R * nuisance.tail<3>() : X.p;
    data.position.row(row) = (F.R.transpose() * (P - F.p)).transpose();
  }

  Eigen::VectorXd through(const Location&, const Eigen::VectorXd*, Random& random) const override {
    std::normal_distribution<double> normal;
    Eigen::VectorXd nuisance(DeviceFrame::kValues + 3);
    nuisance << DeviceFrame::world(), 0.05, 0.02, 0.1;
    if (frame_) {
      Eigen::VectorXd step(DeviceFrame::kFreedom);
      for (double& v : step) v = normal(random);
      DeviceFrame::retract(nuisance.head<DeviceFrame::kValues>(), step);
    }
    return nuisance;
  }

 private:
  int point_at() const { return frame_ ? DeviceFrame::kFreedom : 0; }

  bool frame_, point_;
};

}  // namespace

MethodPtr make_position(SetEntry& entry) {
  const bool frame = read_unknown(entry.fields, "frame");
  const bool point = read_unknown(entry.fields, "point");
  return std::make_unique<Position>(frame, point);
}

}  // namespace selfcal
