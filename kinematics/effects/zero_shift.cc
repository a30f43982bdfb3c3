// Zero shift: a joint's offset steps at `moment` (s), as after a collision or a slipped belt,
//   delta q = step for t >= moment,   step: rad (m prismatic)
// or follows the temperature (`by: temperature`), as where an encoder's bracket warps,
//   delta q = k (T - T0),   k: rad/K (m/K), T0 the `reference` (C; the rows' mean).
#include <algorithm>

#include "kinematics/effects/shared/warmth.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class ZeroShift final : public Effect {
 public:
  ZeroShift(const EffectPlan& plan, int joint) : joint_(joint), warmth_(warmth_by(plan)) {
    const bool turns = plan.robot.joints()[joint].quantity == Quantity::angle;
    if (warmth_) {
      parameters_ = {{"k", turns ? "rad/K" : "m/K", 1e-6, 1e-4}};
    } else {
      parameters_ = {{"step", turns ? "rad" : "m", 5e-5, 5e-3}};
      moment_ = plan.fields.number("moment");
    }
  }

  std::string needs() const override {
    return warmth_ ? "temperatures that change" : "rows with times before and after it";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const bool stepped = at.time >= moment_;
    into.joints(joint_, 0) = warmth_ ? warmth_->above(at) : stepped;
  }

 private:
  void describe_shape(Node& node) const override {
    if (!warmth_) {
      node.set("moment", Node::of(moment_));
      return;
    }
    node.set("by", Node::of(std::string("temperature")));
    warmth_->describe(node);
  }

  int joint_;
  std::optional<Warmth> warmth_;  ///< by: temperature
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
  if (rows.warms) {
    to.add(place.name, {.by = "temperature"});
    to.last().share = 0.3 * std::max(1.0, static_cast<double>(moments.size()));
  } else if (moments.empty()) {
    to.cannot(place.name, "the rows carry no time");
  }
}

}  // namespace selfcal
