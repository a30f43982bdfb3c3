// Zero shift: a joint's offset steps at `moment` (s), as after a collision or a slipped belt.
//   delta q = step for t >= moment.   step: rad (m prismatic).
#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

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

  void regressor(const RegressorInput& at, Regressor& into) const override {
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

void suppose_zero_shift(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  const std::vector<double> moments = rows.moments(-1);
  for (const double moment : moments) to.add(place.name, {.moment = moment});
  if (moments.empty()) to.cannot(place.name, "the rows carry no time");
}

}  // namespace selfcal
