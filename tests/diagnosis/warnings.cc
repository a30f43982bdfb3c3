// What a diagnosis says of itself before one acts on it.
#include "diagnosis/report/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/findings.h"
#include "kinematics/corrected_robot.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Warnings, NameTheEffectsOfTheRobotsFileThatAreNotUsed) {
  const TwoSessions sessions;
  EXPECT_THAT(warning_of_own_effects(*sessions.robot), IsEmpty());
  Node entry = Node::map();
  entry.set("effect", Node::of(std::string("joint_coupling")));
  entry.set("at", Node::of(std::string("j3")));
  entry.set("from", Node::of(std::string("j2")));
  Problems problems;
  const auto corrected = correct(sessions.robot, {entry}, {}, problems);
  ASSERT_NE(corrected, nullptr);
  EXPECT_THAT(warning_of_own_effects(*corrected), HasSubstr("not used (joint_coupling@j3)"));
}

TEST(Warnings, TakeSlidingJointsThatAreOffAlikeForAnInstrumentsScale) {
  const auto robot = robot_of(
      "{robot: r, kind: serial, frames: [{name: base, joint: fixed}, {name: a, joint: prismatic, "
      "alpha: 1.5, limits: [0, 1]}, {name: b, joint: prismatic, alpha: 1.5, limits: [0, 1]}, "
      "{name: c, joint: revolute, alpha: 1.5, limits: [-3, 3]}, {name: tool, joint: fixed, d: "
      "0.1}]}");
  const auto warning = [&](double a, double b, double c) {
    Eigen::VectorXd xi = values(*robot);
    for (const auto& [name, off] :
         {std::pair("a.gear", a), std::pair("b.gear", b), std::pair("c.gear", c)})
      xi[find_parameter(*robot, name)] += off;
    return warning_of_gears(*robot, xi, Eigen::VectorXd::Constant(xi.size(), 1e-5));
  };
  EXPECT_THAT(warning(2e-5, 0, 2e-5), IsEmpty());
  EXPECT_THAT(warning(1e-4, 1.2e-4, 0), AllOf(HasSubstr("K1 100 ppm, K2 120 ppm"),
                                              HasSubstr("all sliding joints by as much")));
  EXPECT_THAT(warning(1e-4, 2e-4, 0), Not(HasSubstr("sliding")));
  EXPECT_THAT(warning(1e-4, 2e-5, 0), Not(HasSubstr("sliding")));
  EXPECT_THAT(warning(0, 0, 1e-4), AllOf(HasSubstr("K3 100 ppm"), Not(HasSubstr("sliding"))));
}

Diagnosis named(double before, double after, double least) {
  Diagnosis diagnosis;
  diagnosis.verdict.effect = "joint_coupling";
  diagnosis.gap.rows = 40;
  diagnosis.gap.rms_before = before;
  diagnosis.gap.rms_after = after;
  diagnosis.gap.rms_all = after;
  diagnosis.gap.closed = diagnosis.gap.closed_all = {0.5, least, 1};
  return diagnosis;
}

TEST(Warnings, SayWhereHardlyAWaveOfAGearIsSeen) {
  const auto robot = robot_of(R"({robot: r, kind: serial, frames: [
    {name: x, joint: prismatic, limits: [0, 2]},
    {name: turn, joint: revolute, alpha: 1.57, d: 0.3, limits: [-3, 3]},
    {name: tool, joint: fixed, d: 0.2}]})");
  const auto named = [](const char* at, double waves) {
    FoundEffect found;
    found.what = {"transmission_error", at, {.waves = {waves}}};
    return std::vector{CauseResult{.effect = "transmission_error", .correction = {found}}};
  };
  Eigen::MatrixXd q(2, 2);
  q << 0.1, -1, 0.8, 1.2;
  EXPECT_THAT(warning_of_few_waves(*robot, q, named("x", 1)),
              HasSubstr("error at x: hardly a wave"));
  EXPECT_EQ(warning_of_few_waves(*robot, q, named("x", 2)), "");
  EXPECT_THAT(warning_of_few_waves(*robot, q, named("turn", 2)), HasSubstr("at turn"));
  EXPECT_EQ(warning_of_few_waves(*robot, q, named("turn", 3)), "");
}

TEST(Warnings, SayThatGravityIsNotThatOfTheEarth) {
  const auto with = [](const std::string& gravity) {
    return warning_of_gravity(*robot_of("{robot: r, kind: serial, " + gravity +
                                        "frames: [{name: j, joint: revolute, d: 0.3}]}"));
  };
  EXPECT_EQ(with(""), "");
  EXPECT_EQ(with("gravity: [9.7, 0, 1.4], "), "") << "hung on a wall";
  EXPECT_THAT(with("gravity: [0, 0, -0.981], "), HasSubstr("0.981 m/s^2 in the robot's file"));
  EXPECT_THAT(with("gravity: [0, 0, 0], "), HasSubstr("nothing has a weight"));
}

TEST(Warnings, SayWhetherTheRowsKeptAsideConfirmTheName) {
  EXPECT_THAT(warning_of_gap(named(2e-4, 1e-4, 0.3)), IsEmpty());
  EXPECT_THAT(warning_of_gap(named(2e-4, 1e-4, 0)),
              AllOf(HasSubstr("too few to confirm it"), HasSubstr("measure more")));
  EXPECT_THAT(warning_of_gap(named(2e-4, 2.1e-4, 0)),
              AllOf(HasSubstr("do not confirm it"), HasSubstr("do not use the corrected model")));
  Diagnosis unjudged = named(2e-4, 1e-4, 0.3);
  unjudged.gap.rows = 0;
  EXPECT_THAT(warning_of_gap(unjudged), HasSubstr("nothing confirms it"));
  // The named effect alone is one thing, the corrected model with everything found another.
  Diagnosis rest_helps = named(2e-4, 2.1e-4, -0.1);
  rest_helps.gap.rms_all = 1e-4;
  EXPECT_THAT(warning_of_gap(rest_helps),
              AllOf(HasSubstr("do not confirm it"), HasSubstr("better with everything found"),
                    Not(HasSubstr("do not use"))));
  Diagnosis rest_tells = named(2e-4, 1e-4, 0);
  rest_tells.gap.closed_all.least = 0.3;
  EXPECT_THAT(warning_of_gap(rest_tells),
              AllOf(HasSubstr("too few to confirm it"), HasSubstr("everything found closes some"),
                    Not(HasSubstr("before the corrected model"))));
  Diagnosis none = named(2e-4, 2.1e-4, 0);
  none.verdict.effect = "none";
  EXPECT_THAT(warning_of_gap(none), IsEmpty());
}

TEST(Warnings, OfGearsStandBesideNoCause) {
  Diagnosis diagnosis;
  diagnosis.verdict.effect = kNone;
  EXPECT_EQ(gears_beside_none(diagnosis), "");
  diagnosis.warnings = {"another", std::string(kGearsOff) + "K2 -1996 ppm; those of all"};
  EXPECT_THAT(gears_beside_none(diagnosis),
              testing::HasSubstr("some are off: K2 -1996 ppm; those of all"));
  diagnosis.verdict.effect = "backlash";
  EXPECT_EQ(gears_beside_none(diagnosis), "");
}

}  // namespace
}  // namespace selfcal
