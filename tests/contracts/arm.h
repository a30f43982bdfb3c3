// A six-axis arm for data sets drawn at random, in two ways. The first frames of one are written so
// that six of their parameters are the motions of the world; the base of the other is a whole pose,
// whose six are these motions, and so are its elbow and its tool.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/files/yaml.h"
#include "kinematics/make_robot.h"
#include "kinematics/robot.h"

namespace selfcal {

inline std::unique_ptr<Robot> arm_of(const std::string& frames) {
  const auto node = parse_yaml("robot: arm\nkind: serial\nframes:\n" + frames, "arm.yaml");
  EXPECT_TRUE(node.has_value());
  Problems problems;
  auto robot = make_robot(*node, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return robot;
}

inline std::unique_ptr<Robot> six_axis_arm() {
  return arm_of(
      "  - {name: world, joint: fixed}\n"                             // z up
      "  - {name: side, joint: fixed, alpha: -1.5707963267948966}\n"  // z along the world's y
      "  - {name: base, joint: fixed, alpha: 1.5707963267948966, r: 0.3}\n"
      "  - {name: j1, joint: revolute, d: 0.05, limits: [-2.8, 2.8]}\n"
      "  - {name: j2, joint: revolute, alpha: -1.57, d: 0.1, limits: [-2.4, 2.4]}\n"
      "  - {name: j3, joint: revolute, d: 0.5, limits: [-2.5, 2.5]}\n"
      "  - {name: j4, joint: revolute, alpha: 1.57, r: 0.45, limits: [-3, 3]}\n"
      "  - {name: j5, joint: revolute, alpha: -1.57, limits: [-2, 2]}\n"
      "  - {name: j6, joint: revolute, alpha: 1.57, limits: [-3, 3]}\n"
      "  - {name: tool, joint: fixed, alpha: 0.7, d: 0.1, theta: 0.4, r: 0.15}\n");
}

inline std::unique_ptr<Robot> arm_of_whole_poses() {
  return arm_of(
      "  - {name: base, joint: fixed, xyz: [0, 0, 0]}\n"
      "  - {name: j1, joint: revolute, d: 0.05, r: 0.3, limits: [-2.8, 2.8]}\n"
      "  - {name: j2, joint: revolute, alpha: -1.57, d: 0.1, limits: [-2.4, 2.4]}\n"
      "  - {name: j3, joint: revolute, d: 0.5, limits: [-2.5, 2.5]}\n"
      "  - {name: elbow, joint: fixed, xyz: [0.02, -0.45, 0.01], rpy: [1.57, 0.03, -0.02]}\n"
      "  - {name: j4, joint: revolute, limits: [-3, 3]}\n"
      "  - {name: j5, joint: revolute, alpha: -1.57, limits: [-2, 2]}\n"
      "  - {name: j6, joint: revolute, alpha: 1.57, limits: [-3, 3]}\n"
      "  - {name: tool, joint: fixed, xyz: [0.1, 0.03, 0.15], rpy: [0.7, -0.5, 0.4]}\n");
}

}  // namespace selfcal
