// Measured distance of the endpoint from a point fixed in the world (a draw-wire encoder, a
// telescoping ball bar with one end held; 11.46 with the other end at rest):
//   r = |P - c| + o - (1 + s) D,   dr = u . (Psi_p dxi - dc) + do - D ds,   u = (P - c) / |P - c|
// The point c is unknown unless `center` gives it, with `offset: unknown` so is o, a length that
// every reading D has too much, with `scale: unknown` s, the share by which it is too short (a
// cable's drum). With `point: unknown` the target is fixed to the last moving link
// at t: P = p_L + R_L t, dP = dp_L - [R_L t]x dphi_L + R_L dt.
#include <algorithm>
#include <cmath>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/unit_normal.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kFlat = 1e-3;  // thickness of rows that are taken to lie in a plane, of their size

class FixedPointDistance final : public Method {
 public:
  /// What is unknown, beside the centre.
  struct Unknown {
    bool offset = false, scale = false, point = false;
  };
  FixedPointDistance(const std::optional<Eigen::Vector3d>& centre, const Unknown& unknown)
      : centre_(centre), unknown_(unknown) {}

  std::string_view name() const override { return "fixed-point-distance"; }
  std::vector<Quantity> equations() const override { return {Quantity::length}; }
  std::vector<MeasuredColumn> measures() const override {
    return {{"distance", Quantity::length, true}};
  }
  bool constrains() const override { return false; }
  /// An unknown point goes along wherever the base is put.
  bool frame_unknown() const override { return !centre_; }
  bool may_leave_scale_free() const override { return unknown_.scale && !centre_; }
  bool point_unknown() const override { return unknown_.point; }
  int tangent_dimension() const override { return point_at() + (unknown_.point ? 3 : 0); }
  Quantity tangent_quantity(int i) const override {
    return unknown_.scale && i == scale_at() ? Quantity::ratio : Quantity::length;
  }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location& tool) const override {
    const Eigen::VectorXd D = data.column("distance")(rows);
    Eigen::MatrixXd P(D.size(), 3);
    for (size_t i = 0; i < X.size(); ++i)
      P.row(static_cast<Eigen::Index>(i)) = target(X[i], tool.p).transpose();
    Eigen::VectorXd nuisance(kValues);
    nuisance << (centre_ ? *centre_ : trilaterated(P, D)), 0, 0, tool.p;
    if (unknown_.offset)
      nuisance[kOffset] =
          (D - (P.rowwise() - nuisance.head<3>().transpose()).rowwise().norm()).mean();
    return nuisance;
  }

  Eigen::Vector3d device(const Eigen::VectorXd& nuisance) const override {
    return nuisance.head<3>();
  }

  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (!centre_) nuisance.head<3>() += step.head<3>();
    if (unknown_.offset) nuisance[kOffset] += step[offset_at()];
    if (unknown_.scale) nuisance[kScale] += step[scale_at()];
    if (unknown_.point) nuisance.tail<3>() += step.tail<3>();
  }

  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    static constexpr const char* kNames[kValues] = {"cx",    "cy",      "cz",      "offset",
                                                    "scale", "point.x", "point.y", "point.z"};
    const bool known[kValues] = {centre_.has_value(), centre_.has_value(), centre_.has_value(),
                                 !unknown_.offset,    !unknown_.scale,     !unknown_.point,
                                 !unknown_.point,     !unknown_.point};
    std::vector<NuisanceReport> list;
    for (int i = 0; i < kValues; ++i) {
      if (known[i]) continue;
      NuisanceReport each{kNames[i], nuisance[i], Eigen::VectorXd::Zero(tangent_dimension()), {}};
      each.D_own[static_cast<Eigen::Index>(list.size())] = 1;
      list.push_back(std::move(each));
    }
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::Vector3d c = in.nuisance->head<3>(), s = in.nuisance->tail<3>();
    const Eigen::VectorXd& measured = in.data->column("distance");
    for (int lane = 0; lane < in.count; ++lane) {
      const Location X = in.now->at(lane);
      const double D = measured[in.rows[lane]];
      const Eigen::Vector3d step = target(X, s) - c;
      const double length = step.norm();
      const Eigen::Vector3d u =
          length > 0 ? Eigen::Vector3d(step / length) : Eigen::Vector3d::Zero();
      out.r(lane, 0) = length + (*in.nuisance)[kOffset] - (1 + (*in.nuisance)[kScale]) * D;
      set_linear(out.G_now, lane, 0, u);
      if (!centre_) out.D_own.row(lane).head<3>() = -u.transpose();
      if (unknown_.offset) out.D_own(lane, offset_at()) = 1;
      if (unknown_.scale) out.D_own(lane, scale_at()) = -D;
      if (!unknown_.point) continue;
      set_angular(out.G_now, lane, 0, (X.R * s).cross(u));
      out.D_own.row(lane).tail<3>() = (X.R.transpose() * u).transpose();
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd& nuisance,
               Observations& data, int row) const override {
    data.column("distance")[row] =
        ((target(X, nuisance.tail<3>()) - nuisance.head<3>()).norm() + nuisance[kOffset]) /
        (1 + nuisance[kScale]);
  }

  Eigen::VectorXd through(const Location& X, const Eigen::VectorXd*,
                          Random& random) const override {
    std::uniform_real_distribution<double> away(0.5, 1.5), zero(0, 0.2), short_by(-0.02, 0.02);
    Eigen::VectorXd nuisance(kValues);
    nuisance << X.p, 0, 0, 0.05, 0.02, 0.1;
    if (centre_)
      nuisance.head<3>() = *centre_;
    else
      nuisance.head<3>() += away(random) * random_direction(random);
    if (unknown_.offset) nuisance[kOffset] = zero(random);
    if (unknown_.scale) nuisance[kScale] = short_by(random);
    return nuisance;
  }

 private:
  /// Own values: c, o, s, t.
  enum Value { kOffset = 3, kScale, kPoint, kValues = kPoint + 3 };

  int offset_at() const { return centre_ ? 0 : 3; }
  int scale_at() const { return offset_at() + (unknown_.offset ? 1 : 0); }
  int point_at() const { return scale_at() + (unknown_.scale ? 1 : 0); }
  Eigen::Vector3d target(const Location& X, const Eigen::Vector3d& s) const {
    return unknown_.point ? Eigen::Vector3d(X.p + X.R * s) : X.p;
  }

  /// |P - c|^2 = (D - o)^2 less its mean over the rows, with p, d and c from the means of P and D:
  ///   2 p . c - 2 o d = |p|^2 - D^2 - mean(|p|^2 - D^2),   linear in c and o;
  /// of rows in a plane, what c is off it follows from |c|^2 = mean((D - o)^2) - mean(|p|^2), on
  /// the lower side, for nothing tells on which it is.
  Eigen::Vector3d trilaterated(const Eigen::MatrixXd& P, const Eigen::VectorXd& D) const {
    const Eigen::RowVector3d mean = P.colwise().mean();
    const Eigen::MatrixXd p = P.rowwise() - mean;
    const Symmetric spread = symmetric_eigen(p.transpose() * p);
    const bool flat = spread.values[0] <= kFlat * kFlat * spread.values[2];
    const Eigen::MatrixXd within = spread.vectors.rightCols(flat ? 2 : 3);
    Eigen::MatrixXd A(D.size(), within.cols() + (unknown_.offset ? 1 : 0));
    A.leftCols(within.cols()) = 2 * p * within;
    if (unknown_.offset) A.rightCols(1).array() = -2 * (D.array() - D.mean());
    const Eigen::VectorXd b = p.rowwise().squaredNorm() - D.cwiseAbs2();
    const Eigen::VectorXd fit = least_squares(A, (b.array() - b.mean()).matrix());
    Eigen::Vector3d c = within * fit.head(within.cols());
    if (flat) {
      const double o = unknown_.offset ? fit.tail<1>()[0] : 0;
      const double off = (D.array() - o).square().mean() - p.rowwise().squaredNorm().mean();
      const Eigen::Vector3d n = spread.vectors.col(0);
      c += std::sqrt(std::max(0.0, off - c.squaredNorm())) * (n.z() > 0 ? -n : n);
    }
    return mean.transpose() + c;
  }

  std::optional<Eigen::Vector3d> centre_;
  Unknown unknown_;
};

}  // namespace

MethodPtr make_fixed_point_distance(SetEntry& entry) {
  std::optional<Eigen::Vector3d> centre;
  if (const auto c = entry.fields.numbers("center", 3)) centre = *c;
  if (centre && centre->norm() > kFarthestPlace)
    entry.fields.fail("center", "metres (millimetres?)");
  FixedPointDistance::Unknown unknown;
  unknown.offset = read_unknown(entry.fields, "offset");
  unknown.scale = read_unknown(entry.fields, "scale");
  unknown.point = read_unknown(entry.fields, "point");
  return std::make_unique<FixedPointDistance>(centre, unknown);
}

}  // namespace selfcal
