// A calibrated robot as a model for MuJoCo (MJCF).
#pragma once

#include <string>
#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal {

/// A joint that gives way.
struct JointSpring {
  std::string joint;      ///< the frame that it moves
  double compliance = 0;  ///< rad/(N m), m/N; positive
};

/// A model, and what it does not hold of the robot.
struct MjcfText {
  std::string text;
  std::vector<std::string> left_out;
};

/// A body a frame, called after it, in the robot's world, with a site `tool` at the last frame. Its
/// joints' positions are the readings; no actuator drives them. Gear ratios and coupling are joints
/// NAME.of.LEADER that follow others by an equality, joints that give way have NAME.spring behind
/// them.
MjcfText mjcf_of(const serial::Model& robot, const std::vector<JointSpring>& springs);

}  // namespace selfcal
