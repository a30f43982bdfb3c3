// Backlash: the joint lags half its play behind its drive,
//   delta q = -play / 2 sign(dq)        (default: the side of the last motion)
//   delta q = +play / 2 sign(tau)       (`by: load`: the torque keeps the gear on one flank)
// tau: gravity's and the wrench's torque on the joint. play: rad (m prismatic).
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/statics.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }  // 0 for NaN

class Backlash final : public Effect {
 public:
  Backlash(const EffectPlan& plan, int joint) : joint_(joint) {
    const bool turns = plan.robot.joints()[joint].quantity == Quantity::angle;
    parameters_ = {{"play", turns ? "rad" : "m", 5e-5, 1.5e-3, true}};
    const std::string by = plan.fields.text("by", "motion");
    by_load_ = by == "load";
    if (!by_load_ && by != "motion") plan.fields.fail("by", "motion or load");
    if (by_load_) plan.torques();
  }

  bool of_torques() const override { return by_load_; }
  std::string needs() const override {
    return by_load_ ? "torques of both signs" : "dq of both signs";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    into.joints(joint_, 0) =
        by_load_ ? sign(at.torque[joint_]) / 2 : -sign(at.velocity[joint_]) / 2;
  }

 private:
  void describe_shape(Node& node) const override {
    if (by_load_) node.set("by", Node::of(std::string("load")));
  }

  int joint_;
  bool by_load_ = false;
};

}  // namespace

std::unique_ptr<Effect> make_backlash(const EffectPlan& plan) {
  return std::make_unique<Backlash>(plan, plan.joint());
}

void suppose_backlash(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  if (rows.context.velocities)
    to.add(place.name);
  else
    to.cannot(place.name, "the rows carry no dq: the side of approach is not known");
  const Statics* statics = rows.robot.statics();
  if (statics ? statics->mechanics().masses_known() || rows.context.loads : weighs(rows.robot))
    to.add(place.name, {.by = "load"});
}

}  // namespace selfcal
