// One passive joint of a platform's chain is locked while the others move (Khalil and Besnard, Self
// calibration of Stewart-Gough parallel robots without extra sensors): the leg keeps its direction
// u in the base (universal joint) or in the platform (spherical joint). With z the leg's direction
// as seen from there, e_1 e_2 u the columns of a rotation, and theta the angle between z and u,
//   r_a = theta / sin(theta) e_a . z, a = 1, 2;   |r| = theta
// The direction at which the joint was locked is unknown: it moves along e_1 and e_2, which turn
// with it, du = t_1 e_1 + t_2 e_2, de_a = -t_a u.
#include <algorithm>
#include <cmath>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/unit_normal.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr int kMostLegs = 6;

/// theta / sin(theta) and its derivative to cos(theta), of vectors whose cross product has length s
/// and whose product is c.
struct Arc {
  double factor = 1, slope = -1.0 / 3;
};
Arc arc_of(double s, double c) {
  constexpr double kSmall = 1e-4;  // below, the next terms of the series are rounding
  if (s < kSmall && c > 0) return {1 + s * s / 6, -1.0 / 3 - 2 * s * s / 15};
  const double theta = std::atan2(s, c);
  return {theta / s, -(s - theta * c) / (s * s * s)};
}

class LockedJoint final : public Method {
 public:
  LockedJoint(int chain, PassiveKind kind) : chain_(chain), kind_(kind) {}

  std::string_view name() const override { return "locked-joint"; }
  std::vector<Quantity> equations() const override { return {2, Quantity::angle}; }
  Body body() const override { return body_behind(chain_, kind_); }
  bool sees_orientation() const override { return false; }
  bool sees_point() const override { return false; }
  bool may_leave_scale_free() const override { return true; }
  int tangent_dimension() const override { return 2; }
  Quantity tangent_quantity(int) const override { return Quantity::angle; }
  Planned planned() const override { return Planned::lock; }
  std::string lock() const override {
    return "leg " + std::to_string(chain_ + 1) +
           (kind_ == PassiveKind::spherical ? " spherical" : " universal");
  }

  Eigen::VectorXd start(const std::vector<Location>& X, const std::vector<int>&,
                        const Observations&, const Eigen::VectorXd*,
                        const Location&) const override {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Location& each : X) mean += each.R.col(2);
    return along(mean.norm() > 0 ? Eigen::Vector3d(mean.normalized()) : Eigen::Vector3d::UnitZ());
  }
  void retract(Eigen::VectorXd& nuisance, const Eigen::VectorXd& step) const override {
    const Eigen::Matrix3d E = axes(nuisance);
    const Eigen::Matrix3d turned = exp_rotation(step[0] * E.col(1) - step[1] * E.col(0)) * E;
    nuisance = Eigen::Quaterniond(turned).coeffs();
  }
  std::vector<NuisanceReport> report(const Eigen::VectorXd& nuisance,
                                     const Eigen::VectorXd*) const override {
    static constexpr const char* kNames[] = {"ux", "uy", "uz"};
    const Eigen::Matrix3d E = axes(nuisance);
    std::vector<NuisanceReport> list;
    for (int i = 0; i < 3; ++i)
      list.push_back({kNames[i], E(i, 2), E.row(i).head<2>().transpose(), {}});
    return list;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    const Eigen::Matrix3d E = axes(*in.nuisance);
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d z = in.now->R(lane).col(2), s = E.transpose() * z;
      const Arc arc = arc_of(s.head<2>().norm(), s.z());
      for (int a = 0; a < 2; ++a) {
        out.r(lane, a) = arc.factor * s[a];
        // dz = turn x z; what r_a gains with z: factor e_a + s_a slope u.
        const Eigen::Vector3d g = arc.factor * E.col(a) + s[a] * arc.slope * E.col(2);
        set_angular(out.G_now, lane, a, z.cross(g));
        for (int b = 0; b < 2; ++b)
          out.D_own(lane, 2 * a + b) =
              s[a] * arc.slope * s[b] - (a == b ? arc.factor * s.z() : 0.0);
      }
    }
  }

  Eigen::VectorXd through(const Location& X, const Eigen::VectorXd*, Random&) const override {
    return along(X.R.col(2));
  }

 private:
  static Eigen::VectorXd along(const Eigen::Vector3d& u) {
    Eigen::Matrix3d E;
    E << tangents(u), u;
    return Eigen::Quaterniond(E).coeffs();
  }
  static Eigen::Matrix3d axes(const Eigen::VectorXd& nuisance) {
    return Eigen::Quaterniond(Eigen::Vector4d(nuisance)).normalized().toRotationMatrix();
  }

  int chain_;
  PassiveKind kind_;
};

}  // namespace

MethodPtr make_locked_joint(SetEntry& entry) {
  const Node* lock = entry.fields.node("lock");
  if (!lock) {
    entry.fields.fail("lock", "{leg: N, joint: universal or spherical}");
    return std::make_unique<LockedJoint>(0, PassiveKind::universal);
  }
  Fields fields(*lock, entry.fields.what() + " lock", entry.problems);
  if (!fields.has("leg")) fields.fail("leg", "a leg from 1");
  const int leg = fields.integer("leg", 1, 1, kMostLegs);
  const std::string joint = fields.text("joint");
  if (joint != "universal" && joint != "spherical") fields.fail("joint", "universal or spherical");
  fields.refuse_unknown();
  return std::make_unique<LockedJoint>(
      leg - 1, joint == "spherical" ? PassiveKind::spherical : PassiveKind::universal);
}

}  // namespace selfcal
