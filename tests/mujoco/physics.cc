// That the simulated arm is the one that the robot file describes, and that it bends as the
// product's formula has it, before anything is asked of its touches.
#include <gtest/gtest.h>

#include "io/files/robot_file.h"
#include "tests/io/scratch.h"
#include "tests/mujoco/cell.h"
#include "tests/support/end_position.h"

namespace selfcal::mujoco {
namespace {

struct EvidenceEvaluator {
  explicit EvidenceEvaluator(double compliance) {
    Random random(7);
    arm = draw_built(draw_arm(random), random);
    for (const char* joint : {"j2", "j3"}) arm.frame(joint).compliance = compliance;
    plates = draw_plates(random);
    scratch.write("arm.robot.yaml", robot_yaml(arm));
    cell = std::make_unique<Cell>(scratch.write("arm.mjcf.xml", mjcf(arm, plates)), plates);
    robot = std::move(load_robot(scratch.folder() / "arm.robot.yaml")).value();
  }
  Scratch scratch;
  Arm arm;
  std::vector<Plate> plates;
  std::unique_ptr<Cell> cell;
  std::unique_ptr<Robot> robot;
};

TEST(MujocoArm, HasItsTipWhereTheRobotFileHasIt) {
  EvidenceEvaluator bench(0);
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd q(6);
    for (double& each : q) each = uniform(random, -3, 3);
    const Eigen::Vector3d p = endpoint(*bench.robot, values(*bench.robot), q);
    // Two chains of ten products each in double precision.
    EXPECT_LT((bench.cell->tip(q) - p).norm(), 1e-12);
  }
}

TEST(MujocoArm, GivesWayByTheComplianceTimesTheTorqueOfItsWeight) {
  constexpr double kCompliance = 5e-6;
  EvidenceEvaluator bench(kCompliance);
  Random random(2);
  int touches = 0;
  for (int tries = 0; tries < 400 && touches < 12; ++tries) {
    const int plate = tries % 4;
    const auto approach = bench.cell->plan(plate, bench.arm, random);
    const auto touch = approach ? bench.cell->touch(*approach) : std::nullopt;
    if (!touch) continue;
    ++touches;
    const auto poses = bench.robot->statics()->link_poses(touch->q);
    for (const int j : {1, 2}) {
      const double torque = joint_torque(bench.robot->statics()->mechanics(), poses, {}, j);
      // The torque is taken at the readings: 1 mrad of give turns up to 250 N m by 0.25 N m. The
      // rest is what swings on from the start of the motion.
      EXPECT_NEAR(touch->give[j], kCompliance * torque, 3e-6) << touch->q.transpose();
    }
    // The touch is where the ball meets the plane with the joints where the springs let them be.
    EXPECT_NEAR(bench.cell->distance(plate, touch->q + touch->give), 0, 1e-9);
  }
  EXPECT_EQ(touches, 12);
}

}  // namespace
}  // namespace selfcal::mujoco
