// What a leg bears: with T the twist of the tip per length of the leg and W the force and moment on
// the tip, the legs hold it in balance where sum f dl + W . dX = 0 for every motion, f the push of
// a leg along itself. So f = -T . W, positive in compression. What the file says weighs (platform,
// links, carriages) adds its own work per length of the leg.
#pragma once

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/statics.h"

namespace selfcal {

/// The weight on a robot of legs: `mass` of an entry (kg, at the tip, by default `standard`).
inline double leg_mass(const EffectPlan& plan, double standard) {
  const double mass = plan.fields.number("mass", standard);
  if (mass < 0) plan.fields.fail("mass", "at least 0 kg");
  return mass;
}

/// Pull on leg `j` along itself (N, negative in compression) by the row's wrench, by what weighs
/// and by `mass` more at the tip.
inline double leg_pull(const RegressorInput& at, int j, double mass) {
  const Eigen::Vector3d force = at.wrench.force + mass * at.gravity;
  return at.legs.col(j).head<3>().dot(force) + at.legs.col(j).tail<3>().dot(at.wrench.moment) +
         at.leg_weights[j];
}

}  // namespace selfcal
