// Robot files of serial robots: there and back, their identity, and what is refused at which line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "kinematics/make_robot.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/kinematics/random_robot.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

// Numbers are written so that they read back bit by bit, but the turns of whole poses come back
// through roll, pitch and yaw: a few epsilon of up to 3 rad, over as many frames and metres.
constexpr double kTurned = 1e-13;

Eigen::VectorXd moved(const Robot& robot, std::mt19937_64& random) {
  Eigen::VectorXd xi = values(robot);
  for (double& v : xi) v += uniform(random, -1e-3, 1e-3);
  return xi;
}

TEST(SerialFile, ComesBackWithTheSameLocationsAndTheMakersFigures) {
  std::mt19937_64 random(51);
  for (int i = 0; i < 10; ++i) {
    const RandomRobot made = random_robot(random);
    const Eigen::VectorXd xi = moved(*made.robot, random);
    const auto back = robot_of(made.robot->text().describe(xi));
    ASSERT_NE(back, nullptr);
    const ConfigurationBlock block = random_block(*made.robot, random);
    Locations X, Y;
    made.robot->locate(block, xi, Body::endpoint, X, nullptr);
    back->locate(block, values(*back), Body::endpoint, Y, nullptr);
    EXPECT_LT((X.position - Y.position).abs().maxCoeff(), kTurned);
    EXPECT_LT((X.rotation - Y.rotation).abs().maxCoeff(), kTurned);
    for (Eigen::Index p = 0; p < xi.size(); ++p) {
      const std::string& field = made.robot->parameters()[p].field;
      const bool turns = field == "rx" || field == "ry" || field == "rz";
      EXPECT_NEAR(values(*back)[p], xi[p], turns ? kTurned : 0);
    }
    EXPECT_EQ(nominal_values(*back), nominal_values(*made.robot));
    EXPECT_EQ(back->preference(), made.robot->preference());
  }
}

TEST(SerialFile, KeepsTheMakersFiguresThroughASecondCalibration) {
  std::mt19937_64 random(52);
  const RandomRobot made = random_robot(random);
  const auto once = robot_of(made.robot->text().describe(moved(*made.robot, random)));
  ASSERT_NE(once, nullptr);
  const auto twice = robot_of(once->text().describe(moved(*once, random)));
  ASSERT_NE(twice, nullptr);
  EXPECT_EQ(nominal_values(*twice), nominal_values(*made.robot));
  EXPECT_EQ(twice->text().identity(), made.robot->text().identity());
}

TEST(SerialFile, KeepsTolerancesLimitsMassesAndGravity) {
  const std::string text =
      "robot: arm\nkind: serial\ngravity: [0, 0, 9.81]\nframes:\n"
      "  - {name: j1, joint: revolute, d: 0.3, limits: [-2, 1.5], tolerance: {d: 5.0e-4, gear: "
      "1.0e-5}}\n"
      "  - {name: tool, joint: fixed, r: 0.1, mass: 2.5, com: [0.1, 0, 0.05]}\n";
  const auto robot = robot_of(text);
  ASSERT_NE(robot, nullptr);
  const auto back = robot_of(robot->text().describe(values(*robot)));
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(back->joints()[0].lower, -2);
  EXPECT_EQ(back->joints()[0].upper, 1.5);
  EXPECT_TRUE(back->joints()[0].limited());
  EXPECT_EQ(back->text().remarks(), robot->text().remarks());  // gravity and static torques
  for (size_t i = 0; i < robot->parameters().size(); ++i) {
    EXPECT_EQ(back->parameters()[i].tolerance, robot->parameters()[i].tolerance);
    EXPECT_EQ(back->parameters()[i].free, robot->parameters()[i].free);
  }
}

TEST(SerialIdentity, IsTheSameForACalibratedFileAndAnotherForAnotherRobot) {
  std::mt19937_64 random(53);
  RandomRobot made = random_robot(random);
  const auto calibrated = robot_of(made.robot->text().describe(moved(*made.robot, random)));
  ASSERT_NE(calibrated, nullptr);
  EXPECT_EQ(calibrated->text().identity(), made.robot->text().identity());
  const auto identity = [&] {
    const auto robot = robot_of(robot_node(made.frames, made.coupling));
    return robot ? robot->text().identity() : std::string();
  };
  EXPECT_EQ(identity(), made.robot->text().identity());
  for (size_t f = 0; f < made.frames.size(); ++f) {
    double& figure = made.frames[f].whole ? (*made.frames[f].whole)[4] : made.frames[f].v[1];
    const double before = std::exchange(figure, figure + 1e-9);
    EXPECT_NE(identity(), made.robot->text().identity()) << f;
    figure = before;
  }
  made.coupling = Eigen::MatrixXd::Identity(made.joints(), made.joints()) * 1.5;
  EXPECT_NE(identity(), made.robot->text().identity());
}

/// First problem of a robot with these frames.
std::string refusal(const std::string& text) {
  Problems problems;
  const auto robot = make_robot(parsed(text), problems);
  EXPECT_EQ(robot, nullptr);
  return problems.any() ? problems.list.front() : "accepted";
}

TEST(SerialFile, IsRefusedForAnUnknownKey) {
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute}\n"
                                  "  - {name: j2, joint: revolute, alhpa: 0.1}\n")),
              testing::AllOf(StartsWith("arm.yaml:5: "), HasSubstr("alhpa")));
  EXPECT_THAT(refusal("robot: arm\nkind: serial\ngravty: [0, 0, 1]\n"
                      "frames:\n  - {name: j1, joint: revolute}\n"),
              testing::AllOf(StartsWith("arm.yaml:3: "), HasSubstr("gravty")));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, tolerance: {dd: 0.1}}\n")),
              testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("dd")));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute}\n"
                                  "  - {name: tool, joint: fixed, gear: 2}\n")),
              testing::AllOf(StartsWith("arm.yaml:5: "), HasSubstr("gear")));
}

TEST(SerialFile, IsRefusedForLimitsThatAreNoInterval) {
  for (const char* limits : {"[1, -1]", "[1, 1]", "[1]", "[1, 2, 3]", "[a, 1]", "1"})
    EXPECT_THAT(refusal(with_frames(
                    "  - {name: j1, joint: revolute, limits: " + std::string(limits) + "}\n")),
                testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("limits")))
        << limits;
}

TEST(SerialFile, IsRefusedWithoutJointsOrFrames) {
  EXPECT_THAT(refusal(with_frames("  - {name: base, joint: fixed}\n")),
              testing::AllOf(StartsWith("arm.yaml:"), HasSubstr("frames"), HasSubstr("joint")));
  EXPECT_THAT(refusal("robot: arm\nkind: serial\nframes: []\n"), HasSubstr("frames"));
  EXPECT_THAT(refusal("robot: arm\nkind: serial\n"), HasSubstr("frames"));
}

TEST(SerialFile, IsRefusedForAFrameNameThatIsUsedTwiceOrCannotBeWritten) {
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute}\n"
                                  "  - {name: j1, joint: revolute}\n")),
              testing::AllOf(StartsWith("arm.yaml:5: "), HasSubstr("'j1'")));
  for (const char* name : {"''", "a.b", "a*", "'a b'"})
    EXPECT_THAT(refusal(with_frames("  - {name: " + std::string(name) + ", joint: revolute}\n")),
                testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("name")))
        << name;
}

TEST(SerialFile, IsRefusedForACouplingThatIsNoRegularSquare) {
  const std::string frames = with_frames(
      "  - {name: j1, joint: revolute}\n"
      "  - {name: j2, joint: revolute}\n");
  for (const char* coupling : {"[[1]]", "[[1, 0]]", "[[1, 0], [0]]", "[[1, 1], [1, 1]]", "1",
                               "[[1, x], [0, 1]]", "[1, 0, 0, 1]"})
    EXPECT_THAT(refusal(frames + "coupling: " + coupling + "\n"),
                testing::AllOf(StartsWith("arm.yaml:6: "), HasSubstr("coupling")))
        << coupling;
}

TEST(SerialFile, IsRefusedForAToleranceThatIsNone) {
  for (const char* tolerance : {"{d: 0}", "{d: -1.0e-3}", "{gear: -1.0e-3}", "{d: x}", "1.0e-3"})
    EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, tolerance: " +
                                    std::string(tolerance) + "}\n")),
                testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("tolerance")))
        << tolerance;
}

TEST(SerialFile, IsRefusedForAMakersFigureInDegreesOrMillimetres) {
  const auto with_nominal = [](const std::string& nominal) {
    return refusal(
        with_frames("  - {name: j1, joint: revolute, theta: 0.1, nominal: {" + nominal + "}}\n"));
  };
  EXPECT_THAT(with_nominal("theta: 90"),
              testing::AllOf(StartsWith("arm.yaml:4: frame 0 nominal: key 'theta'"),
                             HasSubstr("degrees?")));
  EXPECT_THAT(with_nominal("d: 400"), HasSubstr("millimetres?"));
  EXPECT_THAT(with_nominal("gear: 0"), HasSubstr("a ratio other than 0"));
}

TEST(SerialFile, IsRefusedForAJointThatIsNoneAndAMassBelowZero) {
  EXPECT_THAT(
      refusal(with_frames("  - {name: j1, joint: spherical}\n")),
      testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("revolute, prismatic or fixed")));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, mass: -1}\n")),
              testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("mass")));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, com: [0, 0, 0.1]}\n")),
              testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("the mass beside it")));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, mass: 2, com: [0, 0, 100]}\n")),
              HasSubstr("millimetres?"));
  EXPECT_THAT(refusal(with_frames("  - {name: j1, joint: revolute, d: ten}\n")),
              testing::AllOf(StartsWith("arm.yaml:4: "), HasSubstr("'d'")));
}

TEST(MakeRobot, NamesTheKindsItKnows) {
  EXPECT_THAT(robot_kinds(), Contains("serial"));
  EXPECT_THAT(
      refusal("robot: arm\nkind: cereal\n"),
      testing::AllOf(StartsWith("arm.yaml:2: "), HasSubstr("'cereal'"), HasSubstr("serial")));
  EXPECT_THAT(refusal("robot: arm\n"), HasSubstr("kind"));
}

}  // namespace
}  // namespace selfcal
