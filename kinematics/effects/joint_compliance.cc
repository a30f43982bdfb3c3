// Compliance of a joint: it gives way to the torque that it carries,
//   delta q_j = c tau_j(q, load)
// (Kamali et al., equations 6 to 16, with one stiffness 1 / c a joint). Where the maker gives no
// masses, or `lumps: true` asks for it, gravity's torque is made of free first moments instead:
//   delta q_j = sum over carried links k of z_j . (x_k X_k + y_k Y_k) x g / |g|
// X_k, Y_k the axes of link k: the least set that gives any chain of revolute joints its torque.
// The drives of a machine with loops (a delta's carriages) give way to the torque by virtual work
// of what the file says weighs. c: rad/(N m), m/N prismatic; x_k, y_k: rad.
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
    if (!lumps_) {
      parameters_ = {{"c", turns ? "rad/(N m)" : "m/N", 1.5e-7, 1e-4, true}};
      return;
    }
    const Mechanics& mechanics = *chain;
    for (int k = mechanics.link_of(joint); k < static_cast<int>(mechanics.links.size()); ++k) {
      if (!mechanics.links[k].turns) continue;
      carried_.push_back(k);
      for (const char* axis : {"x_", "y_"})
        parameters_.push_back({axis + mechanics.links[k].frame, "rad", 1e-5, 5e-3});
    }
  }

  bool of_torques() const override { return true; }
  std::string needs() const override { return "a load whose torque on the joint changes"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (!lumps_) {
      into.joints(joint_, 0) = at.torque[joint_];
      return;
    }
    const Eigen::Vector3d z = at.poses[at.mechanics->link_of(joint_)].linear().col(2);
    const Eigen::Vector3d down = at.mechanics->gravity.normalized();
    for (size_t i = 0; i < carried_.size(); ++i)
      for (int axis = 0; axis < 2; ++axis)
        into.joints(joint_, 2 * static_cast<Eigen::Index>(i) + axis) =
            z.dot(at.poses[carried_[i]].linear().col(axis).cross(down));
  }

 private:
  void describe_shape(Node& node) const override {
    // Which of the two a file without masses means depends on where it is read: it says so.
    if (lumps_ || silent_) node.set("lumps", Node::of(std::string(lumps_ ? "true" : "false")));
  }

  int joint_;
  bool lumps_ = false, silent_ = false;  ///< silent_: the maker gives no masses
  std::vector<int> carried_;
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
      to.cannot(place.name, std::string(kNoStatics));
    return;
  }
  const Mechanics& mechanics = statics->mechanics();
  if (!(mechanics.gravity.norm() > 0) && !rows.context.loads) return;
  if (!mechanics.masses_known() && !rows.context.loads) return to.add(place.name, {.lumps = true});
  to.add(place.name);
  to.add(place.name, {}, {{.lumps = true}});
  if (mechanics.masses_assumed) to.last().doubt = rows.assumed;
}

}  // namespace selfcal
