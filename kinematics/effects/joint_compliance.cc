// Compliance of a joint: it gives way to the torque that it carries,
//   delta q_j = c tau_j(q, load)
// (Kamali et al., equations 6 to 16, with one stiffness 1 / c a joint), in a machine with loops by
// virtual work. Gears of flexible splines stiffen under load: `by: square` is
//   delta q_j = c2 tau_j |tau_j|,   c2 below zero. Without masses, or with `lumps: true`, free
//   first moments of carried links make it, delta q_j = z_j . (sum over links k that turn of x_k
//   X_k + y_k Y_k
//                      + sum over slides k of z_k l_k Z_k) x g / |g|
// X_k Y_k Z_k the link's axes, l_k how far a slide is out: the least set that gives any chain its
// torque. The force on a slide is its weight alone, delta q_j = z_j Z_j . g / |g|.
// c: rad/(N m), m/N prismatic; c2: the same per N m or N; x_k, y_k: rad; z_k: rad/m, of a slide
// itself m.
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/statics.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class JointCompliance final : public Effect {
 public:
  /// `chain` is null of a machine that is no chain.
  JointCompliance(const EffectPlan& plan, const Mechanics* chain, int joint) : joint_(joint) {
    const bool turns = plan.robot.joints()[static_cast<size_t>(joint)].quantity == Quantity::angle;
    silent_ = chain && !chain->masses_known();
    if (chain) lumps_ = plan.fields.flag("lumps", silent_ && !plan.context.loads);
    const std::string by = plan.fields.text("by", "torque");
    square_ = by == "square";
    if (!square_ && by != "torque") plan.fields.fail("by", "torque or square");
    if (square_ && lumps_) plan.fields.fail("by", "torque: there are no masses to square it of");
    if (square_) {
      parameters_ = {{"c2", turns ? "rad/(N m)^2" : "m/N^2", 1e-10, 2e-6}};
      return;
    }
    if (!lumps_) {
      parameters_ = {{"c", turns ? "rad/(N m)" : "m/N", 1.5e-7, 1e-4, true}};
      return;
    }
    const int own = chain->link_of(joint);
    if (!turns) add_lump(*chain, own, Axis::z, "m");
    for (int k = own; turns && k < static_cast<int>(chain->links.size()); ++k) {
      if (chain->links[k].joint < 0) continue;
      if (!chain->links[k].turns) {
        add_lump(*chain, k, Axis::z, "rad/m");
        continue;
      }
      add_lump(*chain, k, Axis::x, "rad");
      add_lump(*chain, k, Axis::y, "rad");
    }
  }

  bool of_torques() const override { return true; }
  std::string needs() const override { return "a load whose torque on the joint changes"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (!lumps_) {
      const double torque = at.torque[joint_];
      into.joints(joint_, 0) = square_ ? torque * std::abs(torque) : torque;
      return;
    }
    const Link& own = at.mechanics->links[at.mechanics->link_of(joint_)];
    const Eigen::Vector3d z = at.poses[at.mechanics->link_of(joint_)].linear().col(2);
    const Eigen::Vector3d down = at.mechanics->gravity.normalized();
    for (size_t i = 0; i < lumps_at_.size(); ++i)
      into.joints(joint_, static_cast<Eigen::Index>(i)) =
          own.turns ? z.dot(arm(at, lumps_at_[i]).cross(down)) : z.dot(down);
  }

 private:
  enum class Axis { x, y, z };
  struct Lump {
    int link = 0;
    Axis axis = Axis::x;
  };

  void add_lump(const Mechanics& chain, int link, Axis axis, const char* unit) {
    const char* const names[] = {"x_", "y_", "z_"};
    lumps_at_.push_back({link, axis});
    // A moment lies on either side of the joint, a mass pulls downwards.
    parameters_.push_back({names[static_cast<int>(axis)] + chain.links[link].frame, unit, 1e-5,
                           5e-3, axis == Axis::z});
  }

  /// Along the axis: a unit of a link that turns, as far as it is out of a slide.
  static Eigen::Vector3d arm(const RegressorInput& at, const Lump& lump) {
    const auto k = static_cast<size_t>(lump.link);
    const Eigen::Vector3d along = at.poses[k].linear().col(static_cast<int>(lump.axis));
    if (lump.axis != Axis::z) return along;
    Eigen::Vector3d out = at.poses[k].translation();
    if (k > 0) out -= at.poses[k - 1].translation();
    return along * along.dot(out);
  }

  void describe_shape(Node& node) const override {
    if (square_) node.set("by", Node::of(std::string("square")));
    // Which of the two a file without masses means depends on where it is read: it says so.
    if (lumps_ || silent_) node.set("lumps", Node::of(std::string(lumps_ ? "true" : "false")));
  }

  int joint_;
  bool lumps_ = false, silent_ = false;  ///< silent_: the maker gives no masses
  bool square_ = false;                  ///< by: square
  std::vector<Lump> lumps_at_;
};

}  // namespace

std::unique_ptr<Effect> make_joint_compliance(const EffectPlan& plan) {
  if (!plan.torques()) return nullptr;
  const Statics* statics = plan.robot.statics();
  return std::make_unique<JointCompliance>(plan, statics ? &statics->mechanics() : nullptr,
                                           plan.joint());
}

void suppose_joint_compliance(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  const Statics* statics = rows.robot.statics();
  if (!statics) {
    if (rows.robot.leg_parameter(place.joint) == rows.robot.variable_parameter(place.joint))
      to.cannot(place.name, "the joint is the leg itself: see leg_compliance");
    else if (weighs(rows.robot))
      to.add(place.name);
    else
      to.cannot(place.name, std::string(kNoMasses));
    return;
  }
  const Mechanics& mechanics = statics->mechanics();
  if (!(mechanics.gravity.norm() > 0) && !rows.context.loads) return;
  if (!mechanics.masses_known() && !rows.context.loads) return to.add(place.name, {.lumps = true});
  to.add(place.name);
  Slack masses{.shape = {.lumps = true}};
  if (mechanics.masses_assumed) masses.doubt = rows.assumed;
  to.add(place.name, {}, {masses, {.shape = {.by = "square"}}});
}

}  // namespace selfcal
