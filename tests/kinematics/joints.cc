// What a joint's limits allow, and how joints are found.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

std::unique_ptr<Robot> two_joints() {
  return robot_of(
      with_frames("  - {name: j1, joint: revolute, d: 0.3, limits: [-2, 1.5]}\n"
                  "  - {name: j2, joint: prismatic, r: 0.2}\n"));
}

TEST(Joint, GoesThroughItsLimitsOrATurnOrTwoMetres) {
  EXPECT_EQ((Joint{"j", Quantity::angle, -2, 1.5}).range(), 3.5);
  EXPECT_EQ((Joint{"j", Quantity::angle}).range(), 2 * std::numbers::pi);
  EXPECT_EQ((Joint{"j", Quantity::length}).range(), 2);
}

TEST(Joint, WithoutLimitsIsWithinThemAnywhere) {
  const auto robot = two_joints();
  EXPECT_TRUE(within_limits(*robot, Eigen::Vector2d(1.5, 100)));
  EXPECT_FALSE(within_limits(*robot, Eigen::Vector2d(1.5, 100), 0.01));
  EXPECT_TRUE(within_limits(*robot, Eigen::Vector2d(1.46, 100), 0.01)) << "of 3.5 rad";
  EXPECT_FALSE(within_limits(*robot, Eigen::Vector2d(1.47, 100), 0.01)) << "of 3.5 rad";
  EXPECT_FALSE(within_limits(*robot, Eigen::Vector2d(-2.1, 0)));
}

TEST(Joint, IsFoundByItsName) {
  const auto robot = two_joints();
  EXPECT_EQ(find_joint(*robot, "j2"), 1);
  EXPECT_EQ(find_joint(*robot, "j3"), -1);
}

}  // namespace
}  // namespace selfcal
