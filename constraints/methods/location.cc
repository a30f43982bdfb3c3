// Measured location of the endpoint (11.38 to 11.45), the six equations
//   r_p = R_F^T (P - p_F) - x,   r_R = log(R_F^T R R_x^T)
// in the device's axes, F the world unless `frame: unknown`. r_R is u alpha of 11.41 and 11.42 with
// the sign of model minus measurement, exact for large angles: dr_R = Jl^-1(r_R) R_F^T (delta -
// dphi_F).
#include "constraints/methods/maker.h"
#include "constraints/methods/shared/device_frame.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

class LocationMethod final : public Method {
 public:
  explicit LocationMethod(bool frame) : frame_(frame) {}

  std::string_view name() const override { return "location"; }
  std::vector<Quantity> equations() const override {
    return {Quantity::length, Quantity::length, Quantity::length,
            Quantity::angle,  Quantity::angle,  Quantity::angle};
  }
  std::vector<std::string> columns() const override {
    return {"x", "y", "z", "qw", "qx", "qy", "qz"};
  }
  bool constrains() const override { return false; }
  bool frame_unknown() const override { return frame_; }
  int tangent_dimension() const override { return frame_ ? DeviceFrame::kFreedom : 0; }
  Quantity tangent_quantity(int i) const override { return DeviceFrame::quantity(i); }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location&) const override {
    if (!frame_ || rows.empty()) return DeviceFrame::world();
    // The mean rotation (largest eigenvector of the quaternions' second moment), then the shift.
    Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
    for (size_t i = 0; i < rows.size(); ++i) {
      const Eigen::Quaterniond q(X[i].R * measured(data, rows[i]).R.transpose());
      moment += q.coeffs() * q.coeffs().transpose();
    }
    Location F;
    F.R = Eigen::Quaterniond(Eigen::Vector4d(symmetric_eigen(moment).vectors.col(3)))
              .toRotationMatrix();
    for (size_t i = 0; i < rows.size(); ++i)
      F.p += (X[i].p - F.R * measured(data, rows[i]).p) / static_cast<double>(rows.size());
    return to_values(F);
  }

  Eigen::Vector3d device(const Eigen::VectorXd& nuisance) const override {
    return DeviceFrame::pose(nuisance).p;
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (frame_) DeviceFrame::retract(nuisance, step);
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    return frame_ ? DeviceFrame::report(nuisance, tangent_dimension())
                  : std::vector<NuisanceReport>{};
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Location F = DeviceFrame::pose(*in.nuisance);
    const Eigen::Matrix3d to_device = F.R.transpose();
    const int m = tangent_dimension();
    for (int lane = 0; lane < in.count; ++lane) {
      const Location x = measured(*in.data, in.rows[lane]);
      const Eigen::Vector3d step = in.now->p(lane) - F.p;
      const Eigen::Vector3d phi = log_rotation(to_device * in.now->R(lane) * x.R.transpose());
      const Eigen::Matrix3d J = left_jacobian_inverse(phi) * to_device;
      const Eigen::Matrix3d by_turn = to_device * skew(step);
      out.r.row(lane).head<3>() = (to_device * step - x.p).transpose();
      out.r.row(lane).tail<3>() = phi.transpose();
      for (int a = 0; a < 3; ++a) {
        set_linear(out.G_now, lane, a, to_device.row(a));
        set_angular(out.G_now, lane, 3 + a, J.row(a));
        if (!frame_) continue;
        out.D_own.row(lane).segment<3>(a * m) = -to_device.row(a);
        out.D_own.row(lane).segment<3>(a * m + 3) = by_turn.row(a);
        out.D_own.row(lane).segment<3>((3 + a) * m + 3) = -J.row(a);
      }
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    const Location F = DeviceFrame::pose(nuisance);
    const Eigen::VectorXd v = to_values({F.R.transpose() * X.R, F.R.transpose() * (X.p - F.p)});
    data.position.row(row) = v.head<3>().transpose();
    data.orientation.row(row) = v.tail<4>().transpose();
  }

  Eigen::VectorXd through(const Location&, const Eigen::VectorXd*, Random& random) const override {
    std::normal_distribution<double> normal;
    Eigen::VectorXd nuisance = DeviceFrame::world(), step(DeviceFrame::kFreedom);
    for (double& v : step) v = normal(random);
    if (frame_) DeviceFrame::retract(nuisance, step);
    return nuisance;
  }

 private:
  static Location measured(const Observations& data, int row) {
    const auto q = data.orientation.row(row);
    return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(),
            data.position.row(row).transpose()};
  }

  bool frame_;
};

}  // namespace

MethodPtr make_location(SetEntry& entry) {
  return std::make_unique<LocationMethod>(read_unknown(entry.fields, "frame"));
}

}  // namespace selfcal
