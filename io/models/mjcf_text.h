// A calibrated robot as a model for MuJoCo (MJCF).
#pragma once

#include <string>
#include <vector>

#include "io/models/mjcf_effects.h"

namespace selfcal {

/// A model, and what it does not hold of the robot.
struct MjcfText {
  std::string text;
  std::vector<std::string> left_out;
};

/// A body a frame, called after it, in the robot's world, with a site `tool` at the last frame. Its
/// joints' positions are the readings; no actuator drives them. Gear ratios, coupling and drags are
/// joints NAME.of.LEADER that follow others by an equality, joints that give way have NAME.spring
/// behind them, those with play NAME.play, free within its range. Links that give way have two
/// bodies NAME.bend1 and NAME.bend2 on their length, the tool's mount NAME.mount, with springs
/// about all axes.
MjcfText mjcf_of(const serial::Model& robot, const MjcfEffects& effects);

}  // namespace selfcal
