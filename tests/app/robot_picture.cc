// What a page draws of a robot: lines through what carries its tool.
#include "app/report/page/robot_picture.h"

#include <gtest/gtest.h>

#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

TEST(RobotPicture, DrawsADeltasRodsFromItsCarriagesToItsEffector) {
  const auto robot = delta_of_size(1);
  const auto joints = static_cast<Eigen::Index>(robot->joints().size());
  Eigen::VectorXd q(joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const Joint& joint = robot->joints()[static_cast<size_t>(j)];
    q[j] = (joint.lower + joint.upper) / 2;
  }
  const std::vector<RobotLine> lines = robot_lines(*robot, q);
  ASSERT_EQ(lines.size(), 4u) << "three rods and the tool";
  const Eigen::Vector3d effector = lines.back().points.front();
  EXPECT_EQ(lines.back().points.back(), locate(*robot, values(*robot), q, Body::endpoint).p);
  for (int rod = 0; rod < 3; ++rod) {
    const RobotLine& line = lines[static_cast<size_t>(rod)];
    EXPECT_EQ(line.name, robot->links()[static_cast<size_t>(rod)]);
    EXPECT_EQ(line.points.back(), effector);
    const int length = find_parameter(*robot, "rod" + std::to_string(rod + 1));
    ASSERT_GE(length, 0);
    EXPECT_NEAR((line.points.front() - effector).norm(), values(*robot)[length], 1e-9);
  }
}

TEST(RobotPicture, DrawsAnArmThroughItsFrames) {
  const auto robot = arm_of_size(1);
  const std::vector<RobotLine> lines =
      robot_lines(*robot, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot->joints().size())));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].points.size(), robot->statics()->mechanics().links.size());
}

}  // namespace
}  // namespace selfcal
