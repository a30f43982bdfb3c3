// The linear delta: closure, its reasons, and figures worked by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "io/files/yaml.h"
#include "kinematics/make_robot.h"
#include "kinematics/robots/linear_delta.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// `more` after all, `of_towers` in each of them.
std::unique_ptr<Robot> ideal(const std::string& more = "", const std::string& of_towers = "") {
  std::string text = "robot: ideal\nkind: linear-delta\ntowers:\n";
  for (const char* angle : {"0.5235987755982988", "2.6179938779914944", "-1.5707963267948966"})
    text += std::string("  - {radius: 0.3, angle: ") + angle +
            ", rod: 0.5, endstop: 0.9, limits: [-0.5, 0]" + of_towers + "}\n";
  return robot_of(text + more);
}

Closure closure_at(const Robot& robot, const Eigen::Vector3d& q, Locations& X, PsiBlock& psi) {
  return robot.locate(block_of(q), values(robot), Body::endpoint, X, &psi);
}

TEST(LinearDelta, StandsBelowItsCarriagesByTheRodsOtherSide) {
  // 0.5^2 = 0.3^2 + 0.4^2: the effector hangs 0.4 m below carriages at 0.9 - 0.1.
  const Location X = locate(*ideal(), values(*ideal()), Eigen::Vector3d(-0.1, -0.1, -0.1));
  EXPECT_LT((X.p - Eigen::Vector3d(0, 0, 0.4)).norm(), 1e-15);
  EXPECT_TRUE(X.R.isIdentity(0));
}

TEST(LinearDelta, CarriesTheToolWithTheEffectorsTilt) {
  const auto robot = ideal("effector: {rx: 1.5707963267948966}\ntool: [0.01, 0.02, 0.03]\n");
  const Location X = locate(*robot, values(*robot), Eigen::Vector3d(-0.1, -0.1, -0.1));
  EXPECT_LT((X.p - Eigen::Vector3d(0.01, -0.03, 0.42)).norm(), 1e-15);  // y to z, z to -y
}

TEST(LinearDelta, SaysWhichRodsCannotMeet) {
  Locations X;
  PsiBlock psi;
  const auto robot = ideal();
  // Carriages 1 and 2 are 0.3 sqrt 3 apart across: with 0.9 in height, 1.04 m, two rods have 1.
  const Closure apart = closure_at(*robot, Eigen::Vector3d(0, -0.9, -0.4), X, psi);
  ASSERT_FALSE(apart.closes(0));
  EXPECT_EQ(apart.why[0], "no position of the effector: rods 1 and 2 cannot meet");
  EXPECT_TRUE(psi.isZero(0));
  EXPECT_TRUE(X.position.allFinite() && X.rotation.allFinite());
  const auto wide = robot_of(R"(robot: wide
kind: linear-delta
towers:
  - {radius: 0.52, angle: 0.5235987755982988, rod: 0.5, endstop: 0.9}
  - {radius: 0.52, angle: 2.6179938779914944, rod: 0.5, endstop: 0.9}
  - {radius: 0.52, angle: -1.5707963267948966, rod: 0.5, endstop: 0.9}
)");
  // Any two meet, 0.9 m apart, but not all three: the middle is 0.52 m from each.
  const Closure none = closure_at(*wide, Eigen::Vector3d::Zero(), X, psi);
  ASSERT_FALSE(none.closes(0));
  EXPECT_THAT(none.why[0], HasSubstr("three rods do not meet"));
}

TEST(LinearDelta, LeavesOnlyTheLanesOpenThatDoNotClose) {
  const auto robot = ideal();
  ConfigurationBlock block{Eigen::ArrayXXd::Constant(kLanes, 3, -0.1), kLanes};
  block.q.row(7) << 0, -0.9, -0.4;
  Locations X;
  const Closure closure = robot->locate(block, values(*robot), Body::endpoint, X, nullptr);
  EXPECT_EQ(closure.open, 1U << 7);
  EXPECT_LT((X.p(31) - Eigen::Vector3d(0, 0, 0.4)).norm(), 1e-15);
}

TEST(LinearDelta, HoldsScalesAndToolUnlessTheirToleranceIsGiven) {
  const auto robot = ideal("tool: {x: 0.01, tolerance: {z: 1.0e-3}}\n");
  for (const char* held : {"scale1", "effector_rx", "effector_ry", "tool_x", "tool_y"})
    EXPECT_FALSE(robot->parameters()[find_parameter(*robot, held)].free) << held;
  for (const char* free : {"radius1", "angle2", "rod3", "endstop1", "tilt_x2", "tool_z"})
    EXPECT_TRUE(robot->parameters()[find_parameter(*robot, free)].free) << free;
}

TEST(LinearDelta, KeepsItsRodsWithinTheirSwing) {
  const auto robot = ideal("", ", swing: 0.2");
  // With carriages level the rods point as they do in the middle, wherever that is.
  EXPECT_TRUE(robot->within_passive_limits(Eigen::Vector3d(-0.1, -0.1, -0.1)));
  // There 0.3 m across and 0.4 m down. 0.15 m towards tower 1 its rod is 0.15 m across and 0.477 m
  // down: 0.305 rad off the vertical, in place of 0.644.
  const Eigen::Vector3d p(0.15 * std::cos(std::numbers::pi / 6), 0.075, 0.1);
  const auto q = linear_delta::readings_at(values(*robot), p);
  ASSERT_TRUE(q);
  EXPECT_FALSE(robot->within_passive_limits(*q));
  EXPECT_TRUE(ideal()->within_passive_limits(*q)) << "without a swing";
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform;
  Eigen::MatrixX2d span(3, 2);
  span << -0.5, 0, -0.5, 0, -0.5, 0;
  for (int i = 0; i < 50; ++i)
    EXPECT_TRUE(robot->within_passive_limits(robot->draw(span, [&] { return uniform(random); })));
  EXPECT_FALSE(
      robot_of(write_yaml(robot->text().describe(values(*robot))))->within_passive_limits(*q));
}

TEST(LinearDelta, RefusesWhatIsNoDelta) {
  const auto problem = [](const std::string& towers) {
    Problems problems;
    make_robot(parsed("robot: r\nkind: linear-delta\ntowers:\n" + towers), problems);
    return problems.any() ? problems.list.front() : std::string();
  };
  const std::string good = "  - {radius: 0.1, angle: 0, rod: 0.2, endstop: 0.4}\n";
  EXPECT_EQ(problem(good + good + good), "");
  EXPECT_THAT(problem(good + good), HasSubstr("a list of three towers"));
  EXPECT_THAT(problem(good + good + "  - {radius: 0.1, angle: 0, rod: 0.2}\n"),
              HasSubstr("tower3: key 'endstop' is missing"));
  EXPECT_THAT(problem(good + good + "  - {radius: 105, angle: 0, rod: 0.2, endstop: 0.4}\n"),
              HasSubstr("millimetres"));
  EXPECT_THAT(problem(good + good +
                      "  - {radius: 0.1, angle: 0, rod: 0.2, endstop: 0.4, limits: [-350, 0]}\n"),
              HasSubstr("key 'limits': expected metres, at most 50 (millimetres?)"));
  EXPECT_THAT(problem(good + good + "  - {radius: 0.1, angle: 0, rod: 0.2, endstop: 0.4, x: 1}\n"),
              HasSubstr("unknown key 'x'"));
  for (const char* tolerance : {"-1.0e-3", "0", "1"})
    EXPECT_THAT(problem(good + good +
                        "  - {radius: 0.1, angle: 0, rod: 0.2, endstop: 0.4, "
                        "tolerance: {radius: " +
                        tolerance + "}}\n"),
                HasSubstr("tower3: key 'tolerance': expected 1 sigma each, above 0 and below 1"))
        << tolerance;
}

TEST(LinearDelta, TellsAPersonHowFarOutAndHowHighItWorks) {
  const std::vector<std::string> lines = ideal()->text().remarks();
  // 3 / sqrt 10 of 0.5 less 0.3 is 174.3 mm; at the endstops the effector stands at 0.9 - 0.4 m.
  EXPECT_THAT(lines.at(0), HasSubstr("174.3 mm"));
  EXPECT_THAT(lines.at(1), HasSubstr("up to 500.0 mm"));
}

}  // namespace
}  // namespace selfcal
