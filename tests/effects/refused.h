// An arm's file with effects, and why it is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "kinematics/make_robot.h"
#include "tests/effects/effect_case.h"

namespace selfcal {

inline const char* const kArm =
    "robot: arm\nkind: serial\nframes:\n"
    "  - {name: base, joint: fixed, r: 0.5}\n"
    "  - {name: j1, joint: revolute, d: 0.3, mass: 10}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5, d: 0.4, mass: 5}\n"
    "  - {name: j3, joint: prismatic, alpha: 1.5, mass: 2}\n"
    "effects:\n";  // the first effect stands on line 9

/// First problem of the arm with these effects, one a line.
inline std::string refusal(const std::string& entries, const char* of = kArm) {
  Problems problems;
  const auto robot = make_robot(parsed(of + entries), problems);
  EXPECT_EQ(robot, nullptr);
  return problems.any() ? problems.list.front() : "accepted";
}

}  // namespace selfcal
