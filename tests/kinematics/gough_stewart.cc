// The Gough-Stewart platform: closure, its reasons, its passive joints, and figures worked by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/make_robot.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Joints on circles of 0.5 and 0.3 m, pairs 20 degrees apart in the base and 100 in the platform.
std::string regular_hexapod(const std::string& limits = "[0.4, 0.9]",
                            const std::string& more = "") {
  std::string text = "robot: regular\nkind: gough-stewart\nlegs:\n";
  constexpr double kDegree = 0.017453292519943295;
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? -1 : 1, third = 120.0 * (i / 2);
    const double a = kDegree * (third + side * 10), b = kDegree * (third + side * 50);
    text += "  - {base: [" + format_number(0.5 * std::cos(a)) + ", " +
            format_number(0.5 * std::sin(a)) + ", 0], platform: [" +
            format_number(0.3 * std::cos(b)) + ", " + format_number(0.3 * std::sin(b)) +
            ", 0], offset: 0.05, limits: " + limits + more + "}\n";
  }
  return text;
}

/// |b - a|^2 across, of every leg of the regular one: 0.25 + 0.09 - 0.3 cos 40 degrees.
const double kAcross2 = 0.34 - 0.3 * std::cos(40 * 0.017453292519943295);

Eigen::VectorXd equal_legs(double q) { return Eigen::VectorXd::Constant(6, q); }

TEST(GoughStewart, StandsAboveItsBaseByWhatEqualLegsLeave) {
  const auto robot = robot_of(regular_hexapod());
  // A leg is reading and offset: 0.65 + 0.05; its square less that of the way across is height^2.
  const Location X = locate(*robot, values(*robot), equal_legs(0.65));
  EXPECT_LT((X.p - Eigen::Vector3d(0, 0, std::sqrt(0.49 - kAcross2))).norm(), 1e-14);
  EXPECT_LT((X.R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(GoughStewart, RisesByWhatALegsLengthGivesOverItsSteepness) {
  const auto robot = robot_of(regular_hexapod());
  Locations X;
  PsiBlock psi;
  Eigen::MatrixXd J;
  const ConfigurationBlock block = block_of(equal_legs(0.65));
  ASSERT_TRUE(robot->locate(block, values(*robot), Body::endpoint, X, &psi).closes());
  robot->joint_jacobian(block, values(*robot), Body::endpoint, psi, J);
  // All legs together: l dl = h dh; sideways and turns cancel.
  const Eigen::VectorXd together = J.rowwise().sum();
  EXPECT_NEAR(together[2], 0.7 / std::sqrt(0.49 - kAcross2), 1e-12);
  for (const int c : {0, 1, 3, 4, 5}) EXPECT_NEAR(together[c], 0, 1e-12) << c;
}

TEST(GoughStewart, GivesTheLegsDirectionInBaseAndPlatform) {
  const auto robot = robot_of(regular_hexapod());
  const Eigen::VectorXd xi = values(*robot), q = equal_legs(0.65);
  ASSERT_EQ(robot->passive_joints().size(), 12u);
  EXPECT_EQ(robot->passive_joints()[5].name, "leg3.spherical");
  const Location X = locate(*robot, xi, q);
  for (int leg = 0; leg < 6; ++leg) {
    const Eigen::Vector3d a = xi.segment<3>(7 * leg), b = xi.segment<3>(7 * leg + 3);
    const Eigen::Vector3d n = (X.p + X.R * b - a) / 0.7;
    const Location seen = locate(*robot, xi, q, body_behind(leg, PassiveKind::universal));
    EXPECT_LT((seen.R.col(2) - n).norm(), 1e-13);
    EXPECT_EQ(seen.p, a);
    const Location from_platform = locate(*robot, xi, q, body_behind(leg, PassiveKind::spherical));
    EXPECT_LT((from_platform.R.col(2) - X.R.transpose() * n).norm(), 1e-13);
    EXPECT_EQ(from_platform.p, b);
  }
}

TEST(GoughStewart, SaysHowFarLengthsAreFromFittingTogether) {
  const auto robot = robot_of(regular_hexapod());
  Eigen::VectorXd q = equal_legs(0.4);
  q[0] = 0.9;
  q[3] = 0.9;
  Locations X;
  PsiBlock psi;
  const Closure none = robot->locate(block_of(q), values(*robot), Body::endpoint, X, &psi);
  ASSERT_FALSE(none.closes(0));
  EXPECT_THAT(none.why[0], HasSubstr("no location of the platform"));
  EXPECT_TRUE(psi.isZero(0));
  EXPECT_TRUE(X.position.allFinite() && X.rotation.allFinite());
  const Closure gone =
      robot->locate(block_of(equal_legs(-0.06)), values(*robot), Body::endpoint, X, nullptr);
  ASSERT_FALSE(gone.closes(0));
  EXPECT_THAT(gone.why[0], HasSubstr("a chain has no length"));
}

TEST(GoughStewart, StaysInItsAssemblyModeWhereverItStandsWithinItsLimits) {
  // What the inverse says of a pose, the direct model must answer with that pose: of the up to 40
  // that close, the one on home's side.
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  const Eigen::VectorXd xi = values(*robot);
  const Location home = *robot->home();
  for (const double turn : {-0.4, 0.0, 0.4})
    for (const double across : {-0.1, 0.1})
      for (int axis = 0; axis < 3; ++axis) {
        const Location X{exp_rotation(turn * Eigen::Vector3d::Unit(axis)) * home.R,
                         home.p + across * Eigen::Vector3d::Unit((axis + 1) % 3)};
        Eigen::VectorXd q(6);
        for (int leg = 0; leg < 6; ++leg)
          q[leg] = (X.p + X.R * xi.segment<3>(7 * leg + 3) - xi.segment<3>(7 * leg)).norm() -
                   xi[7 * leg + 6];
        const Location there = locate(*robot, xi, q);
        EXPECT_LT((there.p - X.p).norm(), 1e-12);  // rounding over the steepness
        EXPECT_LT((there.R - X.R).norm(), 1e-12);
      }
}

TEST(GoughStewart, ToldToStandBelowItsBaseStandsThere) {
  const auto robot = robot_of(regular_hexapod() + "home: {xyz: [0, 0, -0.4]}\n");
  const Location X = locate(*robot, values(*robot), equal_legs(0.65));
  EXPECT_NEAR(X.p.z(), -std::sqrt(0.49 - kAcross2), 1e-14);
}

TEST(GoughStewart, IsTheSameInALaneWhateverStandsBesideIt) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  ConfigurationBlock block{equal_legs(0.8).transpose().replicate(kLanes, 1).array(), kLanes};
  for (int lane = 0; lane < kLanes; ++lane) block.q(lane, lane % 6) += 0.002 * lane;
  block.q.row(7) << 0.55, 1.15, 0.55, 1.15, 0.55, 1.15;
  Locations X;
  const Closure closure = robot->locate(block, values(*robot), Body::endpoint, X, nullptr);
  for (int lane = 0; lane < kLanes; ++lane) {
    Locations alone;
    const Closure one = robot->locate(block_of(block.q.row(lane).transpose()), values(*robot),
                                      Body::endpoint, alone, nullptr);
    EXPECT_EQ(one.closes(0), closure.closes(lane)) << lane;
    if (one.closes(0)) {
      EXPECT_LT((alone.p(0) - X.p(lane)).norm(), 1e-13) << lane;
    }
  }
}

TEST(GoughStewart, KeepsItsJointsWithinTheirSwing) {
  const auto robot = robot_of(regular_hexapod("[0.4, 0.9]", ", swing: [0.2, 0.25]"));
  const Eigen::VectorXd home = equal_legs(0.65);
  EXPECT_TRUE(within_limits(*robot, home));
  Eigen::VectorXd q = home;
  q[0] = 0.85;
  q[1] = 0.85;  // leans the platform by far more than 0.2 rad
  EXPECT_FALSE(within_limits(*robot, q));
  EXPECT_TRUE(within_limits(*robot_of(regular_hexapod()), q));
}

TEST(GoughStewart, RefusesAFileOfWhichItsFramesOrLimitsAreMissing) {
  const auto problem = [](const std::string& text) {
    Problems problems;
    EXPECT_EQ(make_robot(parsed(text), problems), nullptr);
    return problems.any() ? problems.list.front() : "";
  };
  EXPECT_THAT(problem("robot: a\nkind: gough-stewart\nlegs: []\n"), HasSubstr("six legs"));
  std::string text = regular_hexapod();
  text.erase(text.find(", limits: [0.4, 0.9]"), 20);
  EXPECT_THAT(problem(text), testing::AllOf(HasSubstr("leg1"), HasSubstr("limits")));
  EXPECT_THAT(problem(regular_hexapod("[0.05, 0.1]")),
              HasSubstr("with all readings in the middle of their limits: no location"));
  EXPECT_THAT(problem(regular_hexapod() + "tool: [0, 0, 0]\n"), HasSubstr("tool"));
  EXPECT_THAT(problem(regular_hexapod("[400, 900]")), HasSubstr("millimetres?"));
}

}  // namespace
}  // namespace selfcal
