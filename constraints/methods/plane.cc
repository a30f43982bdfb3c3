// Touches of one plane (11.5.4.1), kept as unit normal n and distance d so that planes through the
// origin are allowed:
//   r = n . (P - rho n_out) - d,   dr = n . Psi_p dxi + P . dn - dd
// rho is the probe's radius, n_out the outward normal of the touched surface (columns nx ny nz).
// The chapter's coefficients (a x + b y + c z + 1 = 0, 11.51) are a b c = -n / d.
// With `parallel_to` the normal is that of another set and |d - d_other| is known.
#include "constraints/methods/plane.h"

#include <cmath>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/unit_normal.h"

namespace selfcal {
namespace {

constexpr double kLargestProbe = 0.2;  // m
const std::string kKnownPlane =
    "[a, b, c] of a x + b y + c z + 1 = 0, which is -n / d of the unit normal n and the distance d "
    "along it; n times 1e9 where the plane goes through the world's origin";

/// What own values [nx ny nz d] mean.
struct NormalForm {
  Eigen::Vector3d n;
  double d;
};

NormalForm normal_form(const Eigen::VectorXd& v) { return {v.head<3>(), v[3]}; }

/// Own values of the plane, d >= 0.
Eigen::VectorXd values_of(const Eigen::Vector3d& n, double d) {
  return (Eigen::VectorXd(4) << (d < 0 ? -1.0 : 1.0) * n, std::abs(d)).finished();
}

/// nx ny nz d a b c of a plane whose n moves by D_n (3 x tangents) and d by D_d, over all freedoms.
std::vector<NuisanceReport> describe(NormalForm plane, Eigen::MatrixXd D_n,
                                     Eigen::RowVectorXd D_d) {
  if (plane.d < 0) {
    plane = {-plane.n, -plane.d};
    D_n = -D_n;
    D_d = -D_d;
  }
  std::vector<NuisanceReport> list;
  static constexpr const char* kNames[] = {"nx", "ny", "nz"};
  for (int i = 0; i < 3; ++i) list.push_back({kNames[i], plane.n[i], D_n.row(i), {}});
  list.push_back({"d", plane.d, D_d, {}});
  if (plane.d < 1e-6) return list;  // a b c do not exist for a plane through the origin
  static constexpr const char* kCoefficients[] = {"a", "b", "c"};
  for (int i = 0; i < 3; ++i)
    list.push_back({kCoefficients[i],
                    -plane.n[i] / plane.d,
                    (-D_n.row(i) / plane.d + plane.n[i] / (plane.d * plane.d) * D_d).transpose(),
                    {},
                    true});
  return list;
}

/// What every plane method shares: the touched point and its columns.
class Touch : public Method {
 public:
  explicit Touch(double probe_radius) : probe_radius_(probe_radius) {}
  std::string_view name() const override { return "plane"; }
  std::vector<Quantity> equations() const override { return {Quantity::length}; }
  Planned planned() const override { return Planned::surface; }
  TouchedSurface touches() const override { return TouchedSurface::plane; }
  std::vector<std::string> columns() const override {
    if (probe_radius_ > 0) return {"nx", "ny", "nz"};
    return {};
  }
  void approach(const Eigen::VectorXd& nuisance, const Eigen::VectorXd* reference,
                Observations& data, int row) const override {
    data.normal.row(row) = (reference ? *reference : nuisance).head<3>().transpose();
  }
  double probe_radius() const { return probe_radius_; }

 protected:
  Eigen::Vector3d touched(const MethodInput& in, int lane) const {
    Eigen::Vector3d P = in.now->p(lane);
    if (probe_radius_ > 0) P -= probe_radius_ * in.data->normal.row(in.rows[lane]).transpose();
    return P;
  }
  /// Where the mean of the points that were touched in `rows` lies along n, of endpoints X.
  double distance_along(const Eigen::Vector3d& n, const std::vector<Location>& X,
                        const std::vector<int>& rows, const Observations& data) const {
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      sum += n.dot(X[i].p);
      if (probe_radius_ > 0) sum -= probe_radius_ * data.normal.row(rows[i]).dot(n);
    }
    return sum / static_cast<double>(rows.size());
  }

 private:
  double probe_radius_;
};

class OnePlane final : public Touch {
 public:
  OnePlane(double probe_radius, const std::optional<NormalForm>& known)
      : Touch(probe_radius), known_(known) {}

  bool may_leave_scale_free() const override { return true; }
  int tangent_dimension() const override { return known_ ? 0 : 3; }
  Quantity tangent_quantity(int i) const override {
    return i < 2 ? Quantity::angle : Quantity::length;
  }
  bool place_known() const override { return known_.has_value(); }
  std::vector<KnownLength> known_lengths() const override {
    if (!known_) return {};
    return {{"distance of the plane from the world's origin", known_->d, 0, true}};
  }
  std::optional<Plane> plane(const Eigen::VectorXd& nuisance,
                             const Eigen::VectorXd*) const override {
    return Plane{nuisance.head<3>(), nuisance[3]};
  }
  Eigen::VectorXd nuisance_of(const Plane& plane) const override {
    return values_of(plane.n, *plane.d);
  }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd*,
                        const Location&) const override {
    if (known_) return values_of(known_->n, known_->d);
    const Eigen::Vector3d n = best_normal(X);
    return values_of(n, distance_along(n, X, rows, data));
  }
  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (known_) return;
    nuisance.head<3>() = tilted(nuisance.head<3>(), step.head<2>());
    nuisance[3] += step[2];
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    if (known_) return {};
    Eigen::MatrixXd D_n = Eigen::MatrixXd::Zero(3, 3);
    D_n.leftCols<2>() = tangents(nuisance.head<3>());
    return describe(normal_form(nuisance), D_n, Eigen::RowVector3d(0, 0, 1));
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const NormalForm plane = normal_form(*in.nuisance);
    const Eigen::Matrix<double, 3, 2> T = tangents(plane.n);
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d P = touched(in, lane);
      out.r(lane, 0) = plane.n.dot(P) - plane.d;
      set_linear(out.G_now, lane, 0, plane.n);
      if (known_) continue;
      out.D_own.row(lane).segment<2>(0) = P.transpose() * T;
      out.D_own(lane, 2) = -1;
    }
  }

  Eigen::VectorXd through(const Location& X, const Eigen::VectorXd*,
                          Random& random) const override {
    if (known_) return values_of(known_->n, known_->d);
    const Eigen::Vector3d n = random_direction(random);
    return values_of(n, n.dot(X.p));
  }

 private:
  std::optional<NormalForm> known_;
};

/// Own values [d, side]: the normal is the reference's, d - d_reference has the sign of `side`.
class ParallelPlane final : public Touch {
 public:
  ParallelPlane(double probe_radius, std::string reference, double distance, double noise)
      : Touch(probe_radius), reference_(std::move(reference)), distance_(distance), noise_(noise) {}

  bool may_leave_scale_free() const override { return true; }
  std::string reference() const override { return reference_; }
  bool can_refer_to(const Method& other) const override {
    return dynamic_cast<const OnePlane*>(&other) != nullptr;
  }
  int tangent_dimension() const override { return 1; }
  std::vector<KnownLength> known_lengths() const override {
    return {{"distance from " + reference_, distance_, noise_, false}};
  }
  std::optional<Plane> plane(const Eigen::VectorXd& nuisance,
                             const Eigen::VectorXd* reference) const override {
    return Plane{reference->head<3>(), nuisance[0]};
  }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>& rows,
                        const Observations& data, const Eigen::VectorXd* reference,
                        const Location&) const override {
    const double d = distance_along(reference->head<3>(), X, rows, data);
    return Eigen::Vector2d(d, d < (*reference)[3] ? -1 : 1);
  }
  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    nuisance[0] += step[0];
  }
  Eigen::VectorXd through(const Location&, const Eigen::VectorXd* reference,
                          Random&) const override {
    return Eigen::Vector2d((*reference)[3] + distance_, 1);
  }
  std::vector<OwnEquation> own_equations(const Eigen::VectorXd& nuisance,
                                         const Eigen::VectorXd* reference) const override {
    const double side = nuisance[1];
    return {{side * (nuisance[0] - (*reference)[3]) - distance_, noise_,
             Eigen::VectorXd::Constant(1, side), Eigen::Vector3d(0, 0, -side)}};
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd* reference) const override {
    const NormalForm plane{reference->head<3>(), nuisance[0]};
    Eigen::MatrixXd D_n = Eigen::MatrixXd::Zero(3, 4);
    D_n.middleCols<2>(1) = tangents(plane.n);
    std::vector<NuisanceReport> list = describe(plane, D_n, Eigen::RowVector4d(1, 0, 0, 0));
    for (NuisanceReport& each : list) {
      each.D_reference = each.D_own.tail<3>();
      each.D_own = Eigen::VectorXd(each.D_own.head<1>());
    }
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::Vector3d n = in.reference->head<3>();
    const Eigen::Matrix<double, 3, 2> T = tangents(n);
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d P = touched(in, lane);
      out.r(lane, 0) = n.dot(P) - (*in.nuisance)[0];
      set_linear(out.G_now, lane, 0, n);
      out.D_own(lane, 0) = -1;
      if (out.D_reference.cols() > 0) out.D_reference.row(lane).head<2>() = P.transpose() * T;
    }
  }

 private:
  std::string reference_;
  double distance_, noise_;
};

}  // namespace

std::shared_ptr<const Method> point_on_plane() {
  return std::make_shared<OnePlane>(0, std::nullopt);
}

double probe_radius(const Method& method) {
  const auto* touch = dynamic_cast<const Touch*>(&method);
  return touch ? touch->probe_radius() : 0;
}

MethodPtr make_plane(SetEntry& entry) {
  const double radius = entry.fields.number("probe_radius", 0);
  if (!(radius >= 0 && radius < kLargestProbe))
    entry.fields.fail("probe_radius", "metres from 0 to 0.2 (millimetres?)");
  const auto known = entry.fields.numbers("plane", 3);
  entry.fields.refuse("normal", "a known plane has `plane`: " + kKnownPlane +
                                    "; where only its normal is known, `method: plane-normal`");
  const Node* parallel = entry.fields.node("parallel_to");
  if (known && parallel) entry.fields.fail("parallel_to", "either `plane` or `parallel_to`");
  if (parallel) {
    Fields fields(*parallel, entry.fields.what() + " parallel_to", entry.problems);
    const std::string other = fields.text("set");
    const Apart apart = read_apart(fields);
    fields.refuse_unknown();
    return std::make_unique<ParallelPlane>(radius, other, apart.distance, apart.noise);
  }
  if (!known) return std::make_unique<OnePlane>(radius, std::nullopt);
  const Eigen::Vector3d abc = *known;
  if (abc.norm() < 1e-9) entry.fields.fail("plane", kKnownPlane);
  return std::make_unique<OnePlane>(radius, NormalForm{-abc.normalized(), 1 / abc.norm()});
}

}  // namespace selfcal
