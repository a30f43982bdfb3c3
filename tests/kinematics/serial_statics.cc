// Gravity on a serial robot, by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "kinematics/robots/serial.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

constexpr double kTorqueRounding = 1e-12;  // N m of tens

serial::Model model_of(const std::string& text) {
  Problems problems;
  const serial::Model model = serial::read(parsed(text), problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return model;
}

/// Two horizontal, parallel axes: z of both joints is -y of the world, so that a positive reading
/// lifts the link from x towards z.
const char* const kArm =
    "  - {name: base, joint: fixed, alpha: 1.5707963267948966}\n"
    "  - {name: j1, joint: revolute, mass: 4, com: [0.25, 0, 0]}\n"
    "  - {name: j2, joint: revolute, d: 0.5, mass: 2, com: [0.15, 0, 0]}\n"
    "  - {name: tool, joint: fixed, d: 0.3, mass: 1}\n";

TEST(StrangeMasses, AreThoseOfAToolOrAPayloadHeavierThanTheArm) {
  const auto said = [](const std::string& tool, const std::string& more = "") {
    std::string text = kArm;
    text.replace(text.rfind("mass: 1"), 7, "mass: " + tool);
    return strange_masses(
        serial::mechanics(model_of("robot: arm\nkind: serial\n" + more + "frames:\n" + text)));
  };
  EXPECT_EQ(said("5.9"), "");
  EXPECT_THAT(said("600"), testing::HasSubstr("the tool weighs 600 kg"));
  EXPECT_THAT(said("600"), testing::HasSubstr("all that carries it 6 kg"));
  EXPECT_EQ(said("1", "payload: 3\n"), "");
  std::string silent = kArm;
  const std::string mass_of_first = ", mass: 4, com: [0.25, 0, 0]";
  silent.erase(silent.find(mass_of_first), mass_of_first.size());
  silent.replace(silent.rfind("mass: 1"), 7, "mass: 600");
  EXPECT_EQ(strange_masses(serial::mechanics(model_of(with_frames(silent)))), "");
  EXPECT_THAT(said("1", "payload: 3000\n"), testing::HasSubstr("the payload is 3000 kg"));
}

TEST(GravityTorques, OfATwoJointArmAreTheOnesWorkedByHand) {
  const serial::Model model = model_of(with_frames(kArm));
  const double g = 9.81;
  // Stretched along x: 4 kg at 0.25 m, 2 kg at 0.65 m, 1 kg at 0.8 m from j1; 0.15 m, 0.3 m from
  // j2.
  const Eigen::VectorXd level = serial::gravity_torques(model, Eigen::Vector2d(0, 0));
  EXPECT_NEAR(level[0], -g * (4 * 0.25 + 2 * 0.65 + 1 * 0.8), kTorqueRounding);
  EXPECT_NEAR(level[1], -g * (2 * 0.15 + 1 * 0.3), kTorqueRounding);
  // Upright: nothing to hold.
  const Eigen::VectorXd upright =
      serial::gravity_torques(model, Eigen::Vector2d(std::numbers::pi / 2, 0));
  EXPECT_LT(upright.norm(), kTorqueRounding);
  // Upper arm up, forearm level: both joints carry the forearm alone.
  const double quarter = std::numbers::pi / 2;
  const Eigen::VectorXd bent = serial::gravity_torques(model, Eigen::Vector2d(quarter, -quarter));
  EXPECT_NEAR(bent[0], -g * 0.6, kTorqueRounding);
  EXPECT_NEAR(bent[1], -g * 0.6, kTorqueRounding);
}

TEST(GravityTorques, TurnTheirSignWithGravity) {
  const serial::Model hung = model_of("gravity: [0, 0, 9.81]\n" + with_frames(kArm));
  EXPECT_NEAR(serial::gravity_torques(hung, Eigen::Vector2d(0, 0))[1], 9.81 * 0.6, kTorqueRounding);
}

TEST(GravityTorques, AreForcesAlongPrismaticJoints) {
  const serial::Model lift = model_of(with_frames(
      "  - {name: j1, joint: prismatic, mass: 3}\n  - {name: tool, joint: fixed, mass: 2}\n"));
  const Eigen::VectorXd force = serial::gravity_torques(lift, Eigen::VectorXd::Constant(1, 0.4));
  EXPECT_NEAR(force[0], -9.81 * 5, kTorqueRounding);
}

TEST(SerialRemarks, SayWhereGravityPointsAndWhatHoldsTheArm) {
  using testing::HasSubstr;
  const auto robot = robot_of(with_frames(kArm));
  ASSERT_NE(robot, nullptr);
  const std::vector<std::string> lines = robot->text().remarks();
  ASSERT_EQ(lines.size(), 4u);
  // y of j1's frame is z of the world.
  EXPECT_THAT(lines[0], testing::AllOf(HasSubstr("j1"), HasSubstr("-9.810")));
  EXPECT_THAT(lines[2], HasSubstr("j1 -30.41 N m"));  // -9.81 x 3.1
  EXPECT_THAT(lines[3], HasSubstr("j2 -5.89 N m"));   // -9.81 x 0.6
  const auto light = robot_of(with_frames("  - {name: j1, joint: revolute}\n"));
  ASSERT_NE(light, nullptr);
  EXPECT_THAT(light->text().remarks(), testing::Contains(HasSubstr("no masses given")));
}

const char* const kSilentArm =
    "  - {name: base, joint: fixed, alpha: 1.5707963267948966}\n"
    "  - {name: j1, joint: revolute}\n"
    "  - {name: j2, joint: revolute, d: 0.5}\n"
    "  - {name: tool, joint: fixed, d: 0.3}\n";

TEST(UsualMasses, StandForTheWholeWhereTheFileGivesNoLinks) {
  // 85 kg of 100 move: j1's link of 0.5 m by 0.5 + 0.15 x 0.5 = 0.575, j2's by 0.65 x 0.075 =
  // 0.04875: 78.357 and 6.643 kg, at 0.25 m and at j2 itself; 0.3 x 10 kg at the tip.
  const serial::Model model = model_of("mass: 100\npayload: 10\n" + with_frames(kSilentArm));
  const Eigen::VectorXd level = serial::gravity_torques(model, Eigen::Vector2d(0, 0));
  EXPECT_NEAR(level[0], -9.81 * (78.3567 * 0.25 + 6.6433 * 0.5 + 3 * 0.8), 1e-2);
  EXPECT_NEAR(level[1], -9.81 * 3 * 0.3, kTorqueRounding);
  EXPECT_TRUE(serial::mechanics(model).masses_assumed);
  // The file that is written says what the one that was read does.
  const Node back = serial::write(model);
  EXPECT_EQ(back.find("mass")->text, "100");
  EXPECT_EQ(back.find("payload")->text, "10");
  for (const Node& frame : back.find("frames")->items) EXPECT_EQ(frame.find("mass"), nullptr);
}

TEST(UsualMasses, GiveWayToTheLinksOwn) {
  const serial::Model model = model_of("mass: 100\n" + with_frames(kArm));
  const serial::Model without = model_of(with_frames(kArm));
  const Eigen::Vector2d q(0.3, -0.2);
  EXPECT_EQ(serial::gravity_torques(model, q), serial::gravity_torques(without, q));
  EXPECT_FALSE(serial::mechanics(model).masses_assumed);
  EXPECT_FALSE(serial::mechanics(model_of(with_frames(kSilentArm))).masses_known());
}

TEST(UsualMasses, AreRefusedWhereTheyCannotBe) {
  for (const char* line : {"mass: 0\n", "mass: -3\n", "payload: -1\n", "mass: heavy\n"}) {
    Problems problems;
    serial::read(parsed(line + with_frames(kSilentArm)), problems);
    EXPECT_EQ(problems.list.size(), 1u) << line;
  }
}

}  // namespace
}  // namespace selfcal
