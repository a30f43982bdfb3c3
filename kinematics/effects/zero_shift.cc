// Zero shift: a joint's offset steps at `moment` (s), as after a collision or a slipped belt,
//   delta q = step for t >= moment,   step: rad (m prismatic)
// or follows the temperature (`by: temperature`), as where an encoder's bracket warps,
//   delta q = k (T - T0),   k: rad/K (m/K), T0 the `reference` (C; the rows' mean).
#include <algorithm>
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class ZeroShift final : public Effect {
 public:
  ZeroShift(const EffectPlan& plan, int joint) : joint_(joint) {
    const bool turns = plan.robot.joints()[joint].quantity == Quantity::angle;
    const std::string by = plan.fields.text("by", "");
    if (!by.empty() && by != "temperature") plan.fields.fail("by", "temperature");
    by_temperature_ = by == "temperature";
    if (by_temperature_) {
      parameters_ = {{"k", turns ? "rad/K" : "m/K", 1e-6, 1e-4}};
      reference_ = plan.reference();
    } else {
      parameters_ = {{"step", turns ? "rad" : "m", 5e-5, 5e-3}};
      moment_ = plan.fields.number("moment");
    }
  }

  std::string needs() const override {
    return by_temperature_ ? "temperatures that change" : "rows with times before and after it";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (!by_temperature_)
      into.joints(joint_, 0) = at.time >= moment_ ? 1 : 0;
    else if (!std::isnan(at.temperature))
      into.joints(joint_, 0) = at.temperature - reference_.value_or(kRoomTemperature);
  }

 private:
  void describe_shape(Node& node) const override {
    if (!by_temperature_) {
      node.set("moment", Node::of(moment_));
      return;
    }
    node.set("by", Node::of(std::string("temperature")));
    if (reference_) node.set("reference", Node::of(*reference_));
  }

  int joint_;
  bool by_temperature_ = false;
  double moment_ = 0;
  std::optional<double> reference_;  ///< C
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
