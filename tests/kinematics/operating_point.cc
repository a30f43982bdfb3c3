// A command is for the robot as it is now: after what has happened to it, under its own gravity.
#include "kinematics/inverse/operating_point.h"

#include <gtest/gtest.h>

#include "kinematics/inverse/compensation.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

constexpr const char* kArm =
    "robot: arm\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, r: 0.3, limits: [-3, 3]}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5707963267948966, limits: [-3, 3]}\n"
    "  - {name: j3, joint: revolute, d: 0.5, limits: [-3, 3]}\n"
    "  - {name: tool, joint: fixed, d: 0.4}\n";

TEST(OperatingPoint, IsAfterEveryMomentThatAnEffectNames) {
  const std::shared_ptr<const Robot> before = robot_of(kArm);
  const std::shared_ptr<const Robot> after = robot_of(
      std::string(kArm) + "effects: [{effect: zero_shift, at: j2, moment: 3600, step: 4.0e-3}]\n");
  const Eigen::Vector3d q(0.3, -0.4, 1.1);
  const Location wanted = locate(*before, values(*before), q);
  const Command command = Compensation(before, after).command(wanted, Eigen::VectorXd(q));
  ASSERT_EQ(command.status, Reach::reached);
  EXPECT_LT((command.q - (q - Eigen::Vector3d(0, 4e-3, 0))).norm(), 1e-9);
  OperatingPoint earlier;
  earlier.time = 3000;
  const Command then = Compensation(before, after, earlier).command(wanted, Eigen::VectorXd(q));
  EXPECT_LT((then.q - q).norm(), 1e-9);
}

TEST(OperatingPoint, WeighsTheLoadByTheGravityOfAMachineWithLoops) {
  for (const double g : {-9.81, 9.81}) {
    const auto robot = robot_of(kind_examples().at("gough-stewart") + "gravity: [0, 0, " +
                                std::to_string(g) + "]\n");
    OperatingPoint at;
    at.mass = 100;
    const MeasurementConditions conditions =
        conditions_at(at, *robot, 2, [](int) { return Eigen::Matrix3d::Identity(); });
    EXPECT_NEAR(conditions.wrench(1, 2), 100 * g, 1e-9);
  }
}

}  // namespace
}  // namespace selfcal
