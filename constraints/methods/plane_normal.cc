// Touches of one plane by its normal (11.5.4.2): consecutive rows of a group differ along the
// plane.
//   r = n . (P_j - P_i),   dr = n . (Psi_j - Psi_i) dxi + (P_j - P_i) . dn
// The normal is known (inclinometers) unless it is left out, and then an unknown of two freedoms.
#include "constraints/methods/maker.h"
#include "constraints/methods/shared/unit_normal.h"

namespace selfcal {
namespace {

class PlaneNormal final : public Method {
 public:
  explicit PlaneNormal(const std::optional<Eigen::Vector3d>& known) : known_(known) {}

  std::string_view name() const override { return "plane-normal"; }
  std::vector<Quantity> equations() const override { return {Quantity::length}; }
  TouchedSurface touches() const override { return TouchedSurface::plane; }
  std::optional<Plane> plane(const Eigen::VectorXd& nuisance,
                             const Eigen::VectorXd*) const override {
    return Plane{nuisance, std::nullopt};
  }
  Eigen::VectorXd nuisance_of(const Plane& plane) const override { return plane.n; }
  bool paired() const override { return true; }
  bool shares_touches() const override { return true; }
  bool may_leave_scale_free() const override { return true; }
  int tangent_dimension() const override { return known_ ? 0 : 2; }
  Quantity tangent_quantity(int) const override { return Quantity::angle; }
  bool place_known() const override { return known_.has_value(); }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>&,
                        const Observations&, const Eigen::VectorXd*,
                        const Location&) const override {
    return known_ ? *known_ : best_normal(X);
  }
  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    if (!known_) nuisance = tilted(nuisance, step);
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    std::vector<NuisanceReport> list;
    if (known_) return list;
    static constexpr const char* kNames[] = {"nx", "ny", "nz"};
    const Eigen::Matrix<double, 3, 2> T = tangents(nuisance);
    for (int i = 0; i < 3; ++i) list.push_back({kNames[i], nuisance[i], T.row(i).transpose(), {}});
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::Vector3d n = *in.nuisance;
    const Eigen::Matrix<double, 3, 2> T = tangents(n);
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d step = in.now->p(lane) - in.before->p(lane);
      out.r(lane, 0) = n.dot(step);
      set_linear(out.G_now, lane, 0, n);
      set_linear(out.G_before, lane, 0, -n);
      if (!known_) out.D_own.row(lane).head<2>() = step.transpose() * T;
    }
  }

  Eigen::VectorXd through(const Location&, const Eigen::VectorXd*, Random& random) const override {
    return known_ ? *known_ : random_direction(random);
  }

 private:
  std::optional<Eigen::Vector3d> known_;
};

}  // namespace

MethodPtr make_plane_normal(SetEntry& entry) {
  return std::make_unique<PlaneNormal>(read_direction(entry.fields, "normal"));
}

}  // namespace selfcal
