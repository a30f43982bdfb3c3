// What happens in the legs of a machine that several carry together.
//   leg_compliance      delta l = c f / (1 + k |f|), by the true weight, whose centre is off the
//   tip leg_thermal_growth  alpha l (T - T0), T lagging behind the air joint_clearance     play / 2
//   tanh(f / f0): the joint's ball settles as the load changes sides
// f: the pull along the leg (N), l its length.
#include <cmath>

#include "sim/trials/trial_causes.h"

namespace selfcal {
namespace {

TrialCause leg_compliance(const TrialWorld& world, Random& random) {
  if (!world.on_legs()) return {};
  const std::vector<ActingJoint> legs = draw_joints(world, random, 0.3);
  std::vector<double> most;
  for (const ActingJoint& each : legs) most.push_back(world.largest_torque(each.joint));
  const double stiffening = uniform(random, 0, 0.5);
  return {.where = names_of(legs),
          .physics = "struts that stiffen under their true weight",
          .act = [=, &world](const Instant& at, Deviation& out) {
            for (size_t i = 0; i < legs.size(); ++i) {
              const double pull = world.torque(at, legs[i].joint) / most[i];
              out.legs[legs[i].joint] +=
                  1e-4 * legs[i].share * pull / (1 + stiffening * std::abs(pull));
            }
          }};
}

TrialCause leg_thermal_growth(const TrialWorld& world, Random& random) {
  if (!world.on_legs()) return {};
  const std::vector<ActingJoint> legs = draw_joints(world, random, 0.3);
  const AirRecord strut = world.air.lagged(uniform(random, 0, 300));
  return {.where = names_of(legs),
          .physics = "a strut that lags a little behind the air",
          .act = [=](const Instant& at, Deviation& out) {
            for (const ActingJoint& each : legs)
              out.legs[each.joint] += 1.2e-5 * each.share *
                                      (strut.at(at.time) - strut.celsius.front()) *
                                      at.lengths[each.joint];
          }};
}

TrialCause joint_clearance(const TrialWorld& world, Random& random) {
  if (!world.on_legs()) return {};
  double loads = 0;
  for (const Instant& each : world.rows) loads += each.force.norm();
  if (loads == 0) return {};  // the weight alone holds every joint to one side of its play
  const std::vector<ActingJoint> legs = draw_joints(world, random, 0);
  const int leg = legs.front().joint;
  const double settles = uniform(random, 0.01, 0.05) * world.largest_torque(leg);
  return {.where = names_of(legs),
          .physics = "play whose ends the load reaches softly",
          .act = [=, &world](const Instant& at, Deviation& out) {
            out.legs[leg] += 5e-5 * std::tanh(world.torque(at, leg) / settles);
          }};
}

}  // namespace

const std::map<std::string, CauseMaker>& leg_causes() {
  static const std::map<std::string, CauseMaker> causes{{"leg_compliance", leg_compliance},
                                                        {"leg_thermal_growth", leg_thermal_growth},
                                                        {"joint_clearance", joint_clearance}};
  return causes;
}

}  // namespace selfcal
