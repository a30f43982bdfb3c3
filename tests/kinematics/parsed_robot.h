// Robots from the text of their file.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/files/yaml.h"
#include "kinematics/make_robot.h"
#include "kinematics/robot.h"

namespace selfcal {

/// The tree of `text`; its places are of file "arm.yaml".
inline Node parsed(const std::string& text) {
  auto node = parse_yaml(text, "arm.yaml");
  EXPECT_TRUE(node.has_value()) << node.error().what;
  return node ? *node : Node::map();
}

/// The robot of `text`, or null with a failed expectation.
inline std::unique_ptr<Robot> robot_of(const Node& node) {
  Problems problems;
  auto robot = make_robot(node, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return robot;
}
inline std::unique_ptr<Robot> robot_of(const std::string& text) { return robot_of(parsed(text)); }

inline std::string with_frames(const std::string& frames) {
  return "robot: arm\nkind: serial\nframes:\n" + frames;
}

}  // namespace selfcal
