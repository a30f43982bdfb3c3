// The endpoint lies on a sphere (a ball probed from all sides, a ball bar, two arms that touch):
//   r = |P - c| - rho,   dr = u . (Psi_p dxi - dc) - drho,   u = (P - c) / |P - c|
// Centre and radius are unknown unless given; the radius is that of the endpoint's locus.
#include <algorithm>
#include <cmath>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/unit_normal.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kSteps = 20;  ///< of a start, which the fit goes on from; 5 to 50 [cost]

class Sphere final : public Method {
 public:
  Sphere(const std::optional<Eigen::Vector3d>& centre, std::optional<double> radius)
      : centre_(centre), radius_(radius) {}

  std::string_view name() const override { return "sphere"; }
  std::vector<Quantity> equations() const override { return {Quantity::length}; }
  TouchedSurface touches() const override { return TouchedSurface::curved; }
  bool may_leave_scale_free() const override { return true; }
  int tangent_dimension() const override { return radius_at() + (radius_ ? 0 : 1); }
  bool place_known() const override { return centre_.has_value(); }
  std::vector<KnownLength> known_lengths() const override {
    if (!radius_) return {};
    return {{"radius", *radius_, 0, true}};
  }

  /// |P|^2 = 2 P . c + (rho^2 - |c|^2), linear in c and the constant.
  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>&,
                        const Observations&, const Eigen::VectorXd*,
                        const Location&) const override {
    Eigen::MatrixXd A(X.size(), 4);
    Eigen::VectorXd b(X.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Location& each : X) mean += each.p / static_cast<double>(X.size());
    for (size_t i = 0; i < X.size(); ++i) {
      const Eigen::Vector3d p = X[i].p - mean;
      A.row(static_cast<Eigen::Index>(i)) << 2 * p.transpose(), 1;
      b[static_cast<Eigen::Index>(i)] = p.squaredNorm();
    }
    const Eigen::Vector4d fit = least_squares(A, b);
    Eigen::VectorXd nuisance(4);
    nuisance.head<3>() = centre_.value_or(mean + fit.head<3>());
    if (radius_ && !centre_) nuisance.head<3>() = middle_of(X, mean, nuisance.head<3>());
    double radius = 0;
    for (const Location& each : X)
      radius += (each.p - nuisance.head<3>()).norm() / static_cast<double>(X.size());
    nuisance[3] = radius_.value_or(radius);
    return nuisance;
  }
  /// A known ball of no size: by a tool that is thought longer by its radius, touches lie on its
  /// other side, where the fit stays.
  Eigen::VectorXd from_afar(const Eigen::VectorXd& nuisance) const override {
    Eigen::VectorXd point = nuisance;
    if (centre_ && radius_) point[3] = 0;
    return point;
  }
  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (!centre_) nuisance.head<3>() += step.head<3>();
    if (!radius_) nuisance[3] += step[radius_at()];
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    static constexpr const char* kNames[] = {"cx", "cy", "cz"};
    std::vector<NuisanceReport> list;
    const auto unit = [&](int i) {
      Eigen::VectorXd D = Eigen::VectorXd::Zero(tangent_dimension());
      D[i] = 1;
      return D;
    };
    for (int i = 0; !centre_ && i < 3; ++i) list.push_back({kNames[i], nuisance[i], unit(i), {}});
    if (!radius_) list.push_back({"radius", nuisance[3], unit(radius_at()), {}});
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::Vector3d c = in.nuisance->head<3>();
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d step = in.now->p(lane) - c;
      const double length = step.norm();
      const Eigen::Vector3d u =
          length > 0 ? Eigen::Vector3d(step / length) : Eigen::Vector3d::Zero();
      out.r(lane, 0) = length - (*in.nuisance)[3];
      set_linear(out.G_now, lane, 0, u);
      if (!centre_) out.D_own.row(lane).head<3>() = -u.transpose();
      if (!radius_) out.D_own(lane, radius_at()) = -1;
    }
  }

  Eigen::VectorXd through(const Location& X, const Eigen::VectorXd*,
                          Random& random) const override {
    std::uniform_real_distribution<double> size(0.05, 0.3);
    Eigen::VectorXd nuisance(4);
    if (centre_) {
      nuisance << *centre_, radius_.value_or((X.p - *centre_).norm());
    } else {
      nuisance[3] = radius_.value_or(size(random));
      nuisance.head<3>() = X.p + nuisance[3] * random_direction(random);
    }
    return nuisance;
  }

 private:
  /// Middle of a ball of the known radius that the points lie on: touches of a small part of it
  /// hardly tell the radius, and without it the ball may come to lie on their other side. Sought
  /// from `given`, and from either side of the plane that they lie nearest to.
  Eigen::Vector3d middle_of(const std::vector<Location>& X, const Eigen::Vector3d& mean,
                            const Eigen::Vector3d& given) const {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Location& each : X)
      spread += (each.p - mean) * (each.p - mean).transpose() / static_cast<double>(X.size());
    const Eigen::Vector3d n = symmetric_eigen(spread).vectors.col(0);
    const double away = std::sqrt(std::max(*radius_ * *radius_ - spread.trace(), 0.0));
    Eigen::Vector3d best = given;
    double least = HUGE_VAL;
    for (Eigen::Vector3d c :
         {given, Eigen::Vector3d(mean + away * n), Eigen::Vector3d(mean - away * n)}) {
      const double squares = settle(X, c);
      if (!(squares < least)) continue;
      least = squares;
      best = c;
    }
    return best;
  }

  /// Gauss and Newton's steps of `c`; what is left of the points, squared.
  double settle(const std::vector<Location>& X, Eigen::Vector3d& c) const {
    double squares = HUGE_VAL;
    for (int step = 0; step < kSteps; ++step) {
      Eigen::Matrix3d A = Eigen::Matrix3d::Identity() * 1e-9 * static_cast<double>(X.size());
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      squares = 0;
      for (const Location& each : X) {
        const double length = (each.p - c).norm();
        if (!(length > 0)) continue;
        const Eigen::Vector3d u = (each.p - c) / length;
        const double r = length - *radius_;
        A += u * u.transpose();
        b += r * u;
        squares += r * r;
      }
      c += A.ldlt().solve(b);
    }
    return squares;
  }

  int radius_at() const { return centre_ ? 0 : 3; }

  std::optional<Eigen::Vector3d> centre_;
  std::optional<double> radius_;
};

}  // namespace

MethodPtr make_sphere(SetEntry& entry) {
  std::optional<Eigen::Vector3d> centre;
  if (const auto c = entry.fields.numbers("center", 3)) centre = *c;
  if (centre && centre->norm() > kFarthestPlace)
    entry.fields.fail("center", "metres (millimetres?)");
  const std::optional<double> radius = entry.fields.optional_number("radius");
  if (radius && !(*radius > 0 && *radius < kLongestPart))
    entry.fields.fail("radius", "metres, above 0 and below 50 (millimetres?)");
  return std::make_unique<Sphere>(centre, radius);
}

}  // namespace selfcal
