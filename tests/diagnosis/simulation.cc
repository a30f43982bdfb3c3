// A robot against its simulator.
#include "diagnosis/comparison/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

Differences asked(const std::shared_ptr<const Robot>& robot, const DataSet& simulated,
                  const DataSet& measured) {
  return differences(diagnose(robot, measured, quick()), diagnose(robot, simulated, quick()),
                     compare(robot, simulated, measured, Between::machines, quick()), quick());
}

TEST(Simulation, DoesNotDifferFromItself) {
  const TwoSessions sessions;
  const Differences of = asked(sessions.robot, sessions.before, sessions.before);
  EXPECT_TRUE(of.robot_only.empty());
  EXPECT_TRUE(of.simulation_only.empty());
  EXPECT_GT(of.geometry.none, 0.5);
  ASSERT_EQ(of.sentences.size(), 1U);
  EXPECT_THAT(of.sentences[0], HasSubstr("no difference"));
}

TEST(Simulation, DiffersInTheZeroThatTheRobotsReadingsAreOffBy) {
  TwoSessions sessions;
  sessions.after.rows.q.col(2).array() += 1e-3;
  const Differences of = asked(sessions.robot, sessions.before, sessions.after);
  EXPECT_TRUE(of.robot_only.empty());
  EXPECT_TRUE(of.simulation_only.empty());
  ASSERT_EQ(of.sentences.size(), 1U);
  EXPECT_THAT(of.sentences[0],
              ::testing::AllOf(HasSubstr("the geometry differs: zero shift at j3 by -"),
                               HasSubstr(" mrad")));
  EXPECT_NEAR(of.geometry.changes[0].values[0].value, -1e-3,
              4 * of.geometry.changes[0].values[0].sigma);
}

TEST(Simulation, LacksTheEffectThatTheRobotHas) {
  TwoSessions sessions(100);
  auto q2 = sessions.after.rows.q.col(1);
  q2.array() += 3e-4 * (3 * q2.array()).sin();
  const Differences of = asked(sessions.robot, sessions.before, sessions.after);
  ASSERT_FALSE(of.robot_only.empty()) << of.sentences[0];
  EXPECT_EQ(of.robot_only[0].effect, "transmission_error");
  EXPECT_EQ(of.robot_only[0].where, "j2");
  EXPECT_TRUE(of.simulation_only.empty());
  EXPECT_THAT(of.sentences[0], HasSubstr("its simulation lacks: transmission error at j2"));
}

Diagnosis diagnosed(const std::string& effect, const std::string& place, double value) {
  Diagnosis diagnosis;
  CauseResult cause{.effect = effect, .where = {place}, .probability = 0.99};
  cause.parameters = {{place + ".c", "rad/(N m)", value, 1e-7, 1e-7, 1e-5}};
  diagnosis.candidates = {cause};
  diagnosis.verdict = cause;
  diagnosis.p_value = 0.005;
  return diagnosis;
}

TEST(Differences, SetsWhatBothHaveSideBySide) {
  const Differences of = differences(diagnosed("joint_compliance", "j2", 3e-6),
                                     diagnosed("joint_compliance", "j2", 1e-6), Comparison{});
  ASSERT_EQ(of.both.size(), 1U);
  ASSERT_EQ(of.both[0].parameters.size(), 1U);
  EXPECT_NEAR(of.both[0].parameters[0].sigmas, 2e-6 / std::hypot(1e-7, 1e-7), 1e-9);
  EXPECT_TRUE(of.robot_only.empty());
  EXPECT_TRUE(of.simulation_only.empty());
  EXPECT_THAT(of.sentences[0], HasSubstr("is in both, but j2.c is 3 urad/(N m) in the robot"));
}

TEST(Differences, AddUpWhatWasFoundTwiceOfOneParameter) {
  Diagnosis robot = diagnosed("joint_compliance", "j2", 1e-6);
  ASSERT_EQ(robot.candidates.size(), 1U);
  robot.candidates[0].parameters.push_back(robot.candidates[0].parameters[0]);
  robot.candidates[0].parameters[1].value = 2e-6;
  const Differences of =
      differences(robot, diagnosed("joint_compliance", "j2", 3e-6), Comparison{});
  ASSERT_EQ(of.both.size(), 1U);
  ASSERT_EQ(of.both[0].parameters.size(), 1U);
  EXPECT_DOUBLE_EQ(of.both[0].parameters[0].robot.value, 3e-6);
  EXPECT_DOUBLE_EQ(of.both[0].parameters[0].robot.sigma, std::hypot(1e-7, 1e-7));
  EXPECT_LT(of.both[0].parameters[0].sigmas, 1e-6);
}

TEST(Differences, TellTheSameEffectAtAnotherPlaceApart) {
  const Differences of = differences(diagnosed("joint_compliance", "j2", 3e-6),
                                     diagnosed("joint_compliance", "j3", 3e-6), Comparison{});
  EXPECT_TRUE(of.both.empty());
  EXPECT_EQ(of.robot_only.size(), 1U);
  EXPECT_EQ(of.simulation_only.size(), 1U);
}

TEST(Differences, CountNoCauseThatNoiseExplainsAsWell) {
  Diagnosis noise = diagnosed("joint_compliance", "j2", 3e-6);
  noise.verdict = {.effect = "none", .probability = 0.4};
  noise.p_value = 0.2;
  EXPECT_TRUE(shown_causes(noise).empty());
}

}  // namespace
}  // namespace selfcal
