// Zero shift: a joint's offset steps at `moment` (s), as after a collision or a slipped belt.
//   delta q = step for t >= moment.   step: rad (m prismatic).
#include "kinematics/effect.h"
#include "kinematics/robot.h"

namespace selfcal {
namespace {

class ZeroShift final : public Effect {
 public:
  ZeroShift(const EffectPlan& plan, int joint) : joint_(joint) {
    const bool turns = plan.robot.joints()[joint].quantity == Quantity::angle;
    parameters_ = {{"step", turns ? "rad" : "m", 5e-5, 5e-3}};
    moment_ = plan.fields.number("moment");
  }

  std::string needs() const override { return "rows with times before and after it"; }

  void regressor(const Circumstances& at, Regressor& into) const override {
    into.joints(joint_, 0) = at.time >= moment_ ? 1 : 0;
  }

 private:
  void describe_shape(Node& node) const override { node.set("moment", Node::of(moment_)); }

  int joint_;
  double moment_ = 0;
};

}  // namespace

std::unique_ptr<Effect> make_zero_shift(const EffectPlan& plan) {
  return std::make_unique<ZeroShift>(plan, plan.joint());
}

}  // namespace selfcal
