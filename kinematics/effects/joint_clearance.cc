// Clearance of a leg's passive joints: the load pulls it to one end of its play or pushes it to the
// other,
//   delta l = play / 2 sign(f),   f the pull of the wrench, of what weighs and of `mass` at the tip
//   (leg_load.h)
// play: m, of both joints of the leg together.
#include "kinematics/effects/shared/leg_load.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class JointClearance final : public Effect {
 public:
  explicit JointClearance(const EffectPlan& plan) : leg_(plan.leg()), mass_(leg_mass(plan, 0)) {
    parameters_ = {{"play", "m", 5e-6, 3e-4, true}};
  }

  bool of_legs() const override { return true; }
  std::string needs() const override { return "loads that pull the leg and loads that push it"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const double pull = leg_pull(at, leg_, mass_);
    const double side = pull > 0 ? 0.5 : pull < 0 ? -0.5 : 0;
    into.tip.col(0) = side * at.legs.col(leg_);
  }

 private:
  void describe_shape(Node& node) const override { node.set("mass", Node::of(mass_)); }

  int leg_;
  double mass_;  ///< kg, at the tip
};

}  // namespace

std::unique_ptr<Effect> make_joint_clearance(const EffectPlan& plan) {
  return std::make_unique<JointClearance>(plan);
}

void suppose_joint_clearance(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0 || rows.robot.leg_parameter(place.joint) < 0) return;
  if (rows.context.loads || weighs(rows.robot))
    to.add(place.name);
  else
    to.cannot(place.name, "the rows carry no loads: which end of its play is not known");
}

}  // namespace selfcal
