// Latency of the trigger: the joints are read `delay` (s) after the touch, so that they stood at
//   delta q = -delay coupling K dq
// when it happened. dq: of the readings in the approach (rad/s, m/s), q the joint variables.
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/effects/shared/touched_surfaces.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class TriggerLatency final : public Effect {
 public:
  explicit TriggerLatency(const MeasurementContext& context) : surfaces_(context) {
    parameters_ = {{"delay", "s", 2e-4, 8e-3, true}};
  }

  bool of_machine() const override { return false; }
  std::string needs() const override { return "touches with velocities dq, at different speeds"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (surfaces_.touched(at) && at.variable_velocity.allFinite())
      into.joints.col(0) = -at.variable_velocity;
  }

 private:
  TouchedSurfaces surfaces_;
};

}  // namespace

std::unique_ptr<Effect> make_trigger_latency(const EffectPlan& plan) {
  plan.expect_place("probe");
  if (plan.context.velocities && !plan.context.speeds)
    plan.fields.fail("effect", "one that signs of dq tell: a latency needs velocities");
  return std::make_unique<TriggerLatency>(plan.context);
}

void suppose_trigger_latency(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole()) return;
  if (!rows.context.touched())
    return to.cannot("probe", "nothing is touched, and only a touch is asked for a latency");
  if (rows.context.speeds)
    to.add("probe");
  else
    to.cannot("probe", rows.context.velocities && !rows.context.speeds
                           ? "the rows carry signs of the approach velocities (`dq: sign`), and a "
                             "latency needs how fast it was"
                           : "the rows carry no approach velocities");
}

}  // namespace selfcal
