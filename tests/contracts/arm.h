// A six-axis arm for data sets drawn at random. Its first frames are written so that six of their
// parameters are the motions of the world.
#pragma once

#include <gtest/gtest.h>

#include <numbers>

#include "io/yaml.h"
#include "kinematics/robot.h"

namespace selfcal {

inline std::unique_ptr<Robot> six_axis_arm() {
  const auto node = parse_yaml(
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: world, joint: fixed}\n"                             // z up
      "  - {name: side, joint: fixed, alpha: -1.5707963267948966}\n"  // z along the world's y
      "  - {name: base, joint: fixed, alpha: 1.5707963267948966, r: 0.3}\n"
      "  - {name: j1, joint: revolute, d: 0.05, limits: [-2.8, 2.8]}\n"
      "  - {name: j2, joint: revolute, alpha: -1.57, d: 0.1, limits: [-2.4, 2.4]}\n"
      "  - {name: j3, joint: revolute, d: 0.5, limits: [-2.5, 2.5]}\n"
      "  - {name: j4, joint: revolute, alpha: 1.57, r: 0.45, limits: [-3, 3]}\n"
      "  - {name: j5, joint: revolute, alpha: -1.57, limits: [-2, 2]}\n"
      "  - {name: j6, joint: revolute, alpha: 1.57, limits: [-3, 3]}\n"
      "  - {name: tool, joint: fixed, alpha: 0.7, d: 0.1, theta: 0.4, r: 0.15}\n",
      "arm.yaml");
  EXPECT_TRUE(node.has_value());
  Problems problems;
  auto robot = make_robot(*node, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return robot;
}

}  // namespace selfcal
