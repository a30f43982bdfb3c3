// Compliance of a leg: it gives way along itself by c times its load,
//   delta l = c f,   f the pull of the wrench, of what weighs and of `mass` at the tip (leg_load.h)
// c: m/N. Where neither the file nor the entry says what weighs, 1 kg hangs there: c is then per
// kilogram of what does.
#include "kinematics/effects/shared/leg_load.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class LegCompliance final : public Effect {
 public:
  explicit LegCompliance(const EffectPlan& plan)
      : leg_(plan.leg()), mass_(leg_mass(plan, weighs(plan.robot) ? 0 : 1)) {
    parameters_ = {{"c", "m/N", 1e-8, 5e-6, true}};
  }

  bool of_legs() const override { return true; }
  std::string needs() const override { return "loads on the leg that change"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    into.tip.col(0) = leg_pull(at, leg_, mass_) * at.legs.col(leg_);
  }

 private:
  void describe_shape(Node& node) const override { node.set("mass", Node::of(mass_)); }

  int leg_;
  double mass_;  ///< kg, at the tip
};

}  // namespace

std::unique_ptr<Effect> make_leg_compliance(const EffectPlan& plan) {
  return std::make_unique<LegCompliance>(plan);
}

void suppose_leg_compliance(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0 || rows.robot.leg_parameter(place.joint) < 0) return;
  // What hangs on the tip is known as the rows' loads, or else by how it bends the legs alone.
  to.add(place.name, {.mass = rows.context.loads || weighs(rows.robot) ? 0.0 : 1.0});
}

}  // namespace selfcal
