// Growth of a leg, or of all alike where none is named, as it warms: delta l = alpha (T - T0) l, l
// its length at the reading. `reference` is T0 (C, default the mean of the record). alpha: 1/K.
#include "kinematics/effects/shared/warmth.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class LegThermalGrowth final : public Effect {
 public:
  explicit LegThermalGrowth(const EffectPlan& plan)
      : leg_(plan.legs() && !plan.place.empty() ? plan.joint() : -1), warmth_(plan) {
    parameters_ = {{"alpha", "1/K", 5e-6, 3e-5, true}};
  }

  bool of_legs() const override { return true; }
  std::string needs() const override { return "temperatures that change"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const double warmer = warmth_.above(at);
    if (leg_ < 0)
      into.tip.col(0) = warmer * at.legs * at.leg_lengths;
    else
      into.tip.col(0) = warmer * at.leg_lengths[leg_] * at.legs.col(leg_);
  }

 private:
  void describe_shape(Node& node) const override { warmth_.describe(node); }

  int leg_;  ///< -1: all
  Warmth warmth_;
};

}  // namespace

std::unique_ptr<Effect> make_leg_thermal_growth(const EffectPlan& plan) {
  return std::make_unique<LegThermalGrowth>(plan);
}

void suppose_leg_thermal_growth(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  // What warms one leg warms them all, more or less.
  const int joint = place.whole() ? 0 : place.joint;
  if (joint < 0 || rows.robot.leg_parameter(joint) < 0) return;
  if (rows.warms)
    to.add(place.name);
  else if (!place.whole())
    to.cannot(place.name, "the rows carry no temperatures that change");
}

}  // namespace selfcal
