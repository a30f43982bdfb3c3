// A link of known length L between a universal joint at the base's origin and one at the tool's
// point, with two inclinometers on it and a rotary sensor about the tool's z (Rauf, Kim and Ryu):
//   p = L (-cos(alpha) sin(beta), sin(alpha), -cos(alpha) cos(beta)),        (4)
//   alpha = asin(p_y / L), beta = atan2(-p_x, -p_z),                         (5)
//   R = Rot(y, theta) Rot(x, psi) Rot(z, phi), phi = atan2(R_10, R_11),      (2)
//   r = (|p| - L, alpha - alpha_m, beta - beta_m, phi - phi_m)               (7, and that the link
//   holds)
// alpha is taken as asin(p_y / |p|), which is the same where the link holds. In (5) the paper's
// tangent leaves the signs out.
#include <cmath>
#include <numbers>

#include "constraints/methods/maker.h"

namespace selfcal {
namespace {

double half_turn(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

class ConstraintLink final : public Method {
 public:
  explicit ConstraintLink(double length) : length_(length) {}

  std::string_view name() const override { return "constraint-link"; }
  std::vector<Quantity> equations() const override {
    return {Quantity::length, Quantity::angle, Quantity::angle, Quantity::angle};
  }
  std::vector<MeasuredColumn> measures() const override {
    return {{"alpha", Quantity::angle}, {"beta", Quantity::angle}, {"phi", Quantity::angle}};
  }
  std::vector<KnownLength> known_lengths() const override {
    return {{"length of the link", length_, 0, true}};
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::VectorXd &alpha = in.data->column("alpha"), &beta = in.data->column("beta"),
                          &phi = in.data->column("phi");
    for (int lane = 0; lane < in.count; ++lane) {
      const int row = in.rows[lane];
      const Location X = in.now->at(lane);
      const Eigen::Vector3d now = angles(X), p = X.p;
      const double l = p.norm(), across2 = p.x() * p.x() + p.z() * p.z();
      out.r(lane, 0) = l - length_;
      out.r(lane, 1) = half_turn(now[0] - alpha[row]);
      out.r(lane, 2) = half_turn(now[1] - beta[row]);
      out.r(lane, 3) = half_turn(now[2] - phi[row]);
      const double across = std::sqrt(across2);
      set_linear(out.G_now, lane, 0, p / l);
      set_linear(out.G_now, lane, 1, (Eigen::Vector3d::UnitY() - p.y() / (l * l) * p) / across);
      set_linear(out.G_now, lane, 2, Eigen::Vector3d(p.z(), 0, -p.x()) / across2);
      // dR_1k = (turn x R e_k)_y; d phi = (R_11 dR_10 - R_10 dR_11) / (R_10^2 + R_11^2).
      const double s = X.R(1, 0), c = X.R(1, 1);
      const Eigen::Vector3d v = (c * X.R.col(0) - s * X.R.col(1)) / (s * s + c * c);
      set_angular(out.G_now, lane, 3, v.cross(Eigen::Vector3d::UnitY()));
    }
  }

  void measure(const Location& X, const Location&, const Eigen::VectorXd&, Observations& data,
               int row) const override {
    const Eigen::Vector3d now = angles(X);
    data.column("alpha")[row] = now[0];
    data.column("beta")[row] = now[1];
    data.column("phi")[row] = now[2];
  }

 private:
  static Eigen::Vector3d angles(const Location& X) {
    return {std::asin(X.p.y() / X.p.norm()), std::atan2(-X.p.x(), -X.p.z()),
            std::atan2(X.R(1, 0), X.R(1, 1))};
  }

  double length_;
};

}  // namespace

MethodPtr make_constraint_link(SetEntry& entry) {
  const double length = entry.fields.number("length");
  if (entry.fields.has("length") && !(length > 0 && length < kLongestPart))
    entry.fields.fail("length", "metres, above 0 and below 50 (millimetres?)");
  return std::make_unique<ConstraintLink>(length);
}

}  // namespace selfcal
