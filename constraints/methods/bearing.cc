// The two angles at which a theodolite sees the endpoint (11.8, optical measuring devices): with v
// the point in the instrument's axes, z upwards,
//   r = (atan2(v_y, v_x) - azimuth, atan2(v_z, h) - elevation),   h = |v_x, v_y|
//   dr = ((-v_y, v_x, 0) / h^2, (-v_x v_z / h, -v_y v_z / h, h) / |v|^2) dv
// The station is the world's origin unless `frame: unknown`, with `point: unknown` the target is
// fixed to the last moving link (see seen_point.h). Directions alone do not tell a large robot from
// a small one nearer by.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/seen_point.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr double kUpright = 1e-9;     // tangent of the angle to the vertical below which it is none
constexpr double kFlatPlaces = 1e-3;  // thickness of places that are taken to lie in a plane

Eigen::Vector2d bearing_of(const Eigen::Vector3d& v) {
  return {std::atan2(v.y(), v.x()), std::atan2(v.z(), std::hypot(v.x(), v.y()))};
}

Eigen::Vector3d direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Pose of the station from places P in the world and the directions d in which it sees them, by
/// direct linear transformation: v = A (P - mean) + b lies along d, so that d x v = 0 is linear in
/// A and b, A the nearest turn times the size that was lost. Of places in a plane the two columns
/// of A within it are asked for, and the third follows.
Eigen::VectorXd resection(const Eigen::MatrixXd& P, const Eigen::MatrixXd& d) {
  const Eigen::RowVector3d mean = P.colwise().mean();
  const Eigen::MatrixXd p = P.rowwise() - mean;
  const Symmetric spread = symmetric_eigen(p.transpose() * p);
  const bool flat = spread.values[0] <= kFlatPlaces * kFlatPlaces * spread.values[2];
  const double size = std::sqrt(std::max(spread.values.sum() / static_cast<double>(p.rows()),
                                         std::numeric_limits<double>::min()));
  const int axes = flat ? 2 : 3;
  Eigen::Matrix3d basis = spread.vectors.rowwise().reverse();  // widest first
  basis.col(2) = basis.col(0).cross(basis.col(1));
  const Eigen::MatrixXd u = p * basis.leftCols(axes) / size;
  const int unknowns = 3 * axes + 3;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    Eigen::Matrix3d across;
    across << 0, -d(i, 2), d(i, 1), d(i, 2), 0, -d(i, 0), -d(i, 1), d(i, 0), 0;
    Eigen::MatrixXd row(3, unknowns);
    for (int k = 0; k < axes; ++k) row.middleCols<3>(3 * k) = u(i, k) * across;
    row.rightCols<3>() = across;
    normal += row.transpose() * row;
  }
  Eigen::VectorXd x = symmetric_eigen(normal).vectors.col(0);
  // What is seen lies in front.
  double ahead = 0;
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    Eigen::Vector3d v = x.tail<3>();
    for (int k = 0; k < axes; ++k) v += u(i, k) * x.segment<3>(3 * k);
    ahead += v.dot(d.row(i).transpose());
  }
  if (ahead < 0) x = -x;
  Eigen::Matrix3d A;
  for (int k = 0; k < axes; ++k) A.col(k) = x.segment<3>(3 * k);
  const double scale = A.leftCols(axes).norm() / std::sqrt(static_cast<double>(axes));
  if (flat) A.col(2) = A.col(0).cross(A.col(1)) / std::max(scale, 1e-12);
  const Eigen::Matrix3d to_device = nearest_rotation(A) * basis.transpose();
  const Eigen::Vector3d b = x.tail<3>() * size / std::max(scale, 1e-12);
  return to_values({to_device.transpose(), mean.transpose() - to_device.transpose() * b});
}

class Bearing final : public Method {
 public:
  explicit Bearing(const SeenPoint& seen) : seen_(seen) {}

  std::string_view name() const override { return "bearing"; }
  std::vector<Quantity> equations() const override { return {2, Quantity::angle}; }
  std::vector<MeasuredColumn> measures() const override {
    return {{"azimuth", Quantity::angle}, {"elevation", Quantity::angle}};
  }
  bool constrains() const override { return false; }
  bool sees_orientation() const override { return false; }
  bool frame_unknown() const override { return seen_.frame_unknown(); }
  bool point_unknown() const override { return seen_.point_unknown(); }
  bool may_leave_scale_free() const override { return true; }
  int tangent_dimension() const override { return seen_.freedom(); }
  Quantity tangent_quantity(int i) const override { return seen_.quantity(i); }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location& tool) const override {
    Eigen::VectorXd nuisance = seen_.start(tool);
    if (!seen_.frame_unknown()) return nuisance;
    const Eigen::VectorXd &azimuth = data.column("azimuth"), &elevation = data.column("elevation");
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd P(count, 3), d(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<size_t>(i);
      P.row(i) = seen_.place(X[at], nuisance).transpose();
      d.row(i) = direction_of(azimuth[rows[at]], elevation[rows[at]]).transpose();
    }
    nuisance.head<DeviceFrame::kValues>() = resection(P, d);
    return nuisance;
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    seen_.retract(nuisance, step);
  }

  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    return seen_.report(nuisance);
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Location F = DeviceFrame::pose(*in.nuisance);
    const Eigen::VectorXd &azimuth = in.data->column("azimuth"),
                          &elevation = in.data->column("elevation");
    for (int lane = 0; lane < in.count; ++lane) {
      const Location X = in.now->at(lane);
      const Eigen::Vector3d v = F.R.transpose() * (seen_.place(X, *in.nuisance) - F.p);
      const Eigen::Vector2d now = bearing_of(v);
      out.r(lane, 0) = wrapped(now[0] - azimuth[in.rows[lane]]);
      out.r(lane, 1) = wrapped(now[1] - elevation[in.rows[lane]]);
      // Straight above or below the azimuth is any.
      const double length = v.norm() > 0 ? v.norm() : 1;
      const double h = std::max(std::hypot(v.x(), v.y()), kUpright * length);
      const Eigen::Vector3d by_azimuth = Eigen::Vector3d(-v.y(), v.x(), 0) / (h * h);
      const Eigen::Vector3d by_elevation =
          Eigen::Vector3d(-v.x() * v.z() / h, -v.y() * v.z() / h, h) / (length * length);
      seen_.chain(by_azimuth, F, *in.nuisance, X, lane, 0, out);
      seen_.chain(by_elevation, F, *in.nuisance, X, lane, 1, out);
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    const Location F = DeviceFrame::pose(nuisance);
    const Eigen::Vector2d now = bearing_of(F.R.transpose() * (seen_.place(X, nuisance) - F.p));
    data.column("azimuth")[row] = now[0];
    data.column("elevation")[row] = now[1];
  }

  /// The station stands well off what it sees.
  Eigen::VectorXd through(const Location& X, const Eigen::VectorXd*,
                          Random& random) const override {
    Eigen::VectorXd nuisance = seen_.random(random);
    if (!seen_.frame_unknown()) return nuisance;
    std::uniform_real_distribution<double> away(3, 5), heading(-std::numbers::pi, std::numbers::pi);
    const double at = heading(random);
    nuisance.head<3>() = X.p + away(random) * Eigen::Vector3d(std::cos(at), std::sin(at), 0.2);
    return nuisance;
  }

 private:
  SeenPoint seen_;
};

}  // namespace

MethodPtr make_bearing(SetEntry& entry) {
  const bool frame = read_unknown(entry.fields, "frame");
  const bool point = read_unknown(entry.fields, "point");
  return std::make_unique<Bearing>(SeenPoint(frame, point));
}

}  // namespace selfcal
