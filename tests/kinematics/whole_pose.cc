// Fixed frames that are whole poses: what their numbers mean, what their six parameters are called,
// how they come back from a file, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "kinematics/make_robot.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/kinematics/random_robot.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// log of a rotation that was composed from its angles: a few epsilon of 1 to 3 rad.
constexpr double kPoseRounding = 1e-14;

const char* const kPoseFrames =
    "  - {name: base, joint: fixed, xyz: [0, 0, 0.5], rpy: [0, 0, 0.3]}\n"
    "  - {name: j1, joint: revolute}\n"
    "  - {name: bend, joint: fixed, xyz: [0.3, 0, 0.1]}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5, d: 0.2}\n"
    "  - {name: tool, joint: fixed, xyz: [0.03, 0, 0.1], rpy: [0.1, pi/2, -0.2],"
    " tolerance: {x: 1.0e-3, rx: 5.0e-3}}\n";

Location tool_of(const std::string& pose) {
  const auto robot =
      robot_of(with_frames("  - {name: j1, joint: revolute}\n  - {name: tool, "
                           "joint: fixed, " +
                           pose + "}\n"));
  return robot ? locate(*robot, values(*robot), Eigen::VectorXd::Zero(1)) : Location{};
}

TEST(WholePose, TurnsByRollThenPitchThenYawAboutTheAxesOfTheFrameBefore) {
  const Location yawed = tool_of("xyz: [0.03, 0, 0.1], rpy: [0, 0, pi/2]");
  EXPECT_TRUE(yawed.p.isApprox(Eigen::Vector3d(0.03, 0, 0.1), kPoseRounding));
  EXPECT_TRUE(yawed.R.col(0).isApprox(Eigen::Vector3d::UnitY(), kPoseRounding));
  // Roll turns y to z; yaw, last, x to y: so z of the tool is -y, then x of the frame before.
  const Location both = tool_of("rpy: [pi/2, 0, pi/2]");
  EXPECT_TRUE(both.R.col(2).isApprox(Eigen::Vector3d::UnitX(), kPoseRounding));
  EXPECT_TRUE(both.R.col(1).isApprox(Eigen::Vector3d::UnitZ(), kPoseRounding));
}

TEST(WholePose, TurnsByItsParametersAboutItsOwnAxes) {
  const auto robot = robot_of(with_frames(kPoseFrames));
  ASSERT_NE(robot, nullptr);
  const Eigen::Vector2d q(0.3, -0.4);
  Eigen::VectorXd xi = values(*robot);
  const Location before = locate(*robot, xi, q);
  xi[find_parameter(*robot, "tool.ry")] = 0.2;
  const Location after = locate(*robot, xi, q);
  EXPECT_EQ(after.p, before.p);
  EXPECT_TRUE((before.R.transpose() * after.R)
                  .isApprox(exp_rotation(Eigen::Vector3d(0, 0.2, 0)), kPoseRounding));
}

TEST(WholePose, HasSixParametersOfItsPartInThePlaceOfFive) {
  const auto robot = robot_of(with_frames(kPoseFrames));
  ASSERT_NE(robot, nullptr);
  std::vector<std::string> names;
  for (const int i : match_parameters(*robot, "tool.*"))
    names.push_back(robot->parameters()[i].name);
  EXPECT_THAT(names, ElementsAre("tool.x", "tool.y", "tool.z", "tool.rx", "tool.ry", "tool.rz"));
  EXPECT_EQ(robot->parameters().size(), 3u * 6 + 2 * 5 + 2);
  EXPECT_EQ(find_parameter(*robot, "theta3"), find_parameter(*robot, "j2.theta"));
  const auto parameter = [&](const char* name) {
    return robot->parameters()[find_parameter(*robot, name)];
  };
  EXPECT_EQ(parameter("base.z").part, Part::base);
  EXPECT_EQ(parameter("base.z").tolerance, 50e-3);
  EXPECT_EQ(parameter("base.z").nominal, 0.5);
  EXPECT_EQ(parameter("bend.x").part, Part::link);
  EXPECT_EQ(parameter("bend.rz").tolerance, 2e-3);
  EXPECT_EQ(parameter("tool.x").tolerance, 1e-3);
  EXPECT_EQ(parameter("tool.y").tolerance, 50e-3);
  EXPECT_EQ(parameter("tool.rx").tolerance, 5e-3);
  EXPECT_EQ(parameter("tool.rx").nominal, 0);
  EXPECT_EQ(unit(parameter("tool.rx").quantity), "rad");
  EXPECT_EQ(unit(parameter("tool.z").quantity), "m");
}

TEST(WholePose, CarriesTheScaleBetweenJointsOnly) {
  const auto robot = robot_of(with_frames(kPoseFrames));
  ASSERT_NE(robot, nullptr);
  std::vector<std::string> lengths;
  for (const Parameter& p : robot->parameters())
    if (p.link_length) lengths.push_back(p.name);
  EXPECT_THAT(lengths, ElementsAre("bend.x", "bend.z", "d3"));
}

TEST(WholePose, ComesFirstInTheOrderOfBaseAndTool) {
  const auto robot = robot_of(with_frames(kPoseFrames));
  ASSERT_NE(robot, nullptr);
  std::vector<std::string> names;
  for (const int i : robot->preference()) names.push_back(robot->parameters()[i].name);
  ASSERT_EQ(names.size(), robot->parameters().size());
  names.resize(23);
  EXPECT_THAT(names, ElementsAre("K1", "K2", "theta1", "theta3",      //
                                 "bend.z", "d3", "bend.x", "alpha3",  //
                                 "base.x", "base.y", "base.z", "base.rx", "base.ry", "base.rz",
                                 "alpha1", "d1", "r1",  //
                                 "tool.x", "tool.y", "tool.z", "tool.rx", "tool.ry", "tool.rz"));
}

TEST(WholePose, KeepsTheMakersPoseBesideWhatWasIdentified) {
  const auto robot = robot_of(with_frames(kPoseFrames));  // its pitch is a quarter turn
  ASSERT_NE(robot, nullptr);
  Eigen::VectorXd xi = values(*robot);
  std::mt19937_64 random(91);
  for (double& v : xi) v += uniform(random, -0.02, 0.02);
  const auto back = robot_of(robot->text().describe(xi));
  ASSERT_NE(back, nullptr);
  EXPECT_LT((values(*back) - xi).cwiseAbs().maxCoeff(), kPoseRounding);
  EXPECT_EQ(nominal_values(*back), nominal_values(*robot));
  EXPECT_EQ(back->text().identity(), robot->text().identity());
  const Eigen::Vector2d q(0.3, -0.4);
  const Location one = locate(*robot, xi, q), other = locate(*back, values(*back), q);
  EXPECT_LT((one.R - other.R).norm() + (one.p - other.p).norm(), kPoseRounding);
  // What the file says now is what it says ever after.
  const auto again = robot_of(back->text().describe(values(*back)));
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(values(*again), values(*back));
}

TEST(WholePose, IsWrittenAsItWasGivenWhereNothingMoved) {
  const auto robot = robot_of(with_frames(kPoseFrames));
  ASSERT_NE(robot, nullptr);
  const Node node = robot->text().describe(values(*robot));
  const Node& tool = node.find("frames")->items[4];
  EXPECT_EQ(tool.find("rpy")->items[0].text, "0.1");
  EXPECT_EQ(tool.find("rpy")->items[1].text, format_number(std::numbers::pi / 2));
  EXPECT_EQ(tool.find("xyz")->items[0].text, "0.03");
  EXPECT_EQ(tool.find("nominal"), nullptr);
  EXPECT_EQ(node.find("frames")->items[2].find("rpy")->items.size(), 3u);
}

TEST(WholePose, HasItsMakersPoseForTheCentreOfThePrior) {
  const auto robot =
      robot_of(with_frames("  - {name: j1, joint: revolute}\n"
                           "  - {name: tool, joint: fixed, xyz: [0.031, 0, 0.1], rpy: [0, 0, 0.52],"
                           " nominal: {xyz: [0.03, 0, 0.1], rpy: [0, 0, 0.5]}}\n"));
  ASSERT_NE(robot, nullptr);
  const int x = find_parameter(*robot, "tool.x"), rz = find_parameter(*robot, "tool.rz");
  EXPECT_EQ(robot->parameters()[x].value, 0.031);
  EXPECT_EQ(robot->parameters()[x].nominal, 0.03);
  EXPECT_NEAR(robot->parameters()[rz].value, 0.02, kPoseRounding);
  EXPECT_EQ(robot->parameters()[rz].nominal, 0);
}

std::string pose_refusal(const std::string& frames) {
  Problems problems;
  const auto robot = make_robot(parsed(with_frames(frames)), problems);
  EXPECT_EQ(robot, nullptr);
  return problems.any() ? problems.list.front() : "accepted";
}

TEST(WholePose, IsRefusedWithTheLine) {
  const struct {
    const char *frame, *told;
  } cases[] = {
      {"joint: revolute, xyz: [0, 0, 1]", "only a fixed frame may be a whole pose"},
      {"joint: prismatic, rpy: [0, 0, 1]", "only a fixed frame may be a whole pose"},
      {"joint: fixed, xyz: [0, 0, 1], theta: 0.1", "unknown key 'theta'"},
      {"joint: fixed, xyz: [0, 0]", "a list of 3 numbers"},
      {"joint: fixed, xyz: [0, 0, 100]", "metres, each at most 50 (millimetres?)"},
      {"joint: fixed, rpy: [0, 0, 90]", "radians, each at most"},
      {"joint: fixed, xyz: [0, 0, 1], tolerance: {d: 0.1}", "unknown key 'd'"},
      {"joint: fixed, xyz: [0, 0, 1], tolerance: {x: 0}", "above 0 and below 1"},
      {"joint: fixed, xyz: [0, 0, 1], nominal: {x: 0}", "unknown key 'x'"},
  };
  for (const auto& each : cases)
    EXPECT_THAT(pose_refusal("  - {name: j1, joint: revolute}\n  - {name: tool, " +
                             std::string(each.frame) + "}\n"),
                AllOf(StartsWith("arm.yaml:5: "), HasSubstr(each.told)))
        << each.frame;
}

}  // namespace
}  // namespace selfcal
