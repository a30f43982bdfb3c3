// What breaks on the simulated robot when its scenario says so, and how a tool comes to sit.
#include <gmock/gmock.h>

#include "tests/sim/machine_cell.h"

namespace selfcal {
namespace {

std::vector<MotionReply::Outcome> outcomes(Machine& machine) {
  std::vector<MotionReply> replies;
  machine.take(replies);
  std::vector<MotionReply::Outcome> out;
  for (const MotionReply& reply : replies) out.push_back(reply.outcome);
  return out;
}

TEST(MachineFault, TakesTheEncoderSamplesAwayForAWhile) {
  Machine machine = machine_of(table("faults: [{what: encoders, at: 0.5, for: 0.25}]"));
  std::vector<EncoderSample> samples;
  machine.advance(kSecond);
  machine.take(samples);
  EXPECT_EQ(samples.size(), 500u - 125u);
  for (const EncoderSample& sample : samples)
    EXPECT_FALSE(sample.time >= kSecond / 2 && sample.time < 3 * kSecond / 4) << sample.time;
}

TEST(MachineFault, HoldsTheTriggerClosedForAWhile) {
  Machine machine = machine_of(table("faults: [{what: stuck, at: 1, for: 2}]"));
  Touched touched;
  pass(machine, kSecond / 2, touched);
  EXPECT_FALSE(machine.closed());
  pass(machine, kSecond, touched);
  EXPECT_TRUE(machine.closed());
  pass(machine, 2 * kSecond, touched);
  EXPECT_FALSE(machine.closed());
  ASSERT_EQ(touched.edges.size(), 2u);
  EXPECT_TRUE(touched.edges[0].closed);
  EXPECT_FALSE(touched.edges[1].closed);
}

TEST(MachineFault, KeepsAStuckTriggerClosedThroughARetract) {
  Machine machine = machine_of(table("faults: [{what: stuck, at: 0}]"));
  const Touched touched = touch(machine, planned_touches()[0], "a");
  EXPECT_FALSE(std::ranges::any_of(touched.edges, [](const Edge& edge) { return !edge.closed; }));
  go(machine, MoveKind::retract, planned_touches()[0].start);
  EXPECT_TRUE(machine.closed());
}

TEST(MachineFault, RefusesEveryMoveForAWhile) {
  Machine machine = machine_of(table("faults: [{what: refuse, at: 0, for: 1}]"));
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, ""));
  EXPECT_EQ(outcomes(machine), std::vector{MotionReply::Outcome::refused});
  machine.advance(2 * kSecond);
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, ""));
  EXPECT_EQ(outcomes(machine), std::vector{MotionReply::Outcome::accepted});
}

TEST(MachineFault, NeitherAnswersNorMovesWhileItIsSilent) {
  Machine machine = machine_of(table("faults: [{what: silent, at: 0, for: 1}]"));
  Touched touched;
  pass(machine, kSecond / 100, touched);
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, ""));
  const EncoderSample before = touched.samples.last();
  pass(machine, kSecond / 2, touched);
  EXPECT_TRUE(outcomes(machine).empty());
  EXPECT_EQ(touched.samples.last().counts, before.counts);
}

TEST(MachineFault, LetsOneEncoderReadTooMuchForAWhile) {
  Machine machine =
      machine_of(table("faults: [{what: misread, joint: j3, by: 0.25, at: 0.5, for: 0.25}]"));
  const auto off = [&](Nanoseconds t, int joint) {
    return static_cast<double>(machine.sample(t).counts[joint]) * machine.scales()[joint].step -
           home()[joint];
  };
  EXPECT_NEAR(off(kSecond / 4, 2), 0, 1e-9);  // steps of 1e-9 rad
  EXPECT_NEAR(off(kSecond / 2, 2), 0.25, 1e-9);
  EXPECT_NEAR(off(kSecond / 2, 1), 0, 1e-9);
  EXPECT_NEAR(off(3 * kSecond / 4, 2), 0, 1e-9);
}

TEST(MachineFault, IsRefusedOfAJointThatTheRobotLacks) {
  Problems problems;
  const Machine machine(table("faults: [{what: misread, joint: j9, by: 0.25}]"),
                        {std::shared_ptr<void>(), &rx90()}, home(), problems);
  ASSERT_TRUE(problems.any());
  EXPECT_THAT(problems.list.front(), testing::HasSubstr("the robot has no joint j9"));
}

TEST(MachineFault, IsRefusedWhenNobodyKnowsIt) {
  EXPECT_THAT(problem_of("robot: r\nmachine: {faults: [{what: rust, at: 0}]}\n"
                         "sets: {a: {method: plane}}\n"),
              testing::HasSubstr(
                  "encoders, stuck, refuse, silent, lock_refuse, lock_late, lock_open or misread"));
}

TEST(Machine, WarmsUpAsItIsTold) {
  Machine machine = machine_of(table("temperature: 21.5, warming: 4"));
  EXPECT_DOUBLE_EQ(machine.celsius(), 21.5);
  machine.advance(1800 * kSecond);
  EXPECT_DOUBLE_EQ(machine.celsius(), 23.5);
}

TEST(Machine, NeedsToKnowHowFarItsSurfacesReach) {
  Problems problems;
  const Machine machine(scenario_of("robot: r\nsets: {a: {method: plane}}\n"),
                        {std::shared_ptr<void>(), &rx90()}, home(), problems);
  ASSERT_TRUE(problems.any());
  EXPECT_THAT(problems.list.front(), testing::HasSubstr("`within`"));
}

TEST(Machine, RefusesAPlaneOfWhichOnlyTheNormalIsKnown) {
  Problems problems;
  const Machine machine(scenario_of("robot: r\nsets: {a: {method: plane-normal}}\n"),
                        {std::shared_ptr<void>(), &rx90()}, home(), problems);
  ASSERT_TRUE(problems.any());
  EXPECT_THAT(problems.list.front(), testing::HasSubstr("planes, locks or `places`"));
}

// ---------------------------------------------------------------------------- sockets

Eigen::Vector3d true_endpoint(const Machine& machine, const EncoderSample& sample) {
  return locate(machine.robot(), machine.truth().xi, reading_of(sample, machine.scales())).p;
}

TEST(Machine, SeatsTheToolInTheTrueSocketAndClosesTheTriggerThere) {
  // The sockets lie where the nominal robot's endpoint comes at these readings, 1 to 2 mm off.
  std::vector<Eigen::VectorXd> readings;
  std::string places;
  for (int i = 0; i < 12; ++i) {
    Eigen::VectorXd q = home();
    q[0] += 0.1 * i - 0.6;
    q[1] += 0.05 * (i % 5);
    q[4] -= 0.07 * (i % 3);
    const Eigen::Vector3d p =
        locate(rx90(), values(rx90()), q).p + 1e-3 * Eigen::Vector3d(i % 2, 1, -1);
    places += (i ? ", [" : "[") + format_number(p.x()) + ", " + format_number(p.y()) + ", " +
              format_number(p.z()) + "]";
    readings.push_back(q);
  }
  const Scenario scenario = scenario_of(
      "robot: r\nseed: 4\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nmachine: {}\nsets:\n"
      "  nests: {method: position-constraint, noise: 1.0e-5, noise_true: 0, places: [" +
      places + "]}\n");
  Machine machine = machine_of(scenario);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Eigen::VectorXd start = readings[i];
    start[1] += 0.03;
    go(machine, MoveKind::travel, start);
    const Touched touched = go(machine, MoveKind::seat, readings[i], "n" + std::to_string(i));
    ASSERT_TRUE(touched.closing) << i;
    EXPECT_TRUE(machine.closed());
    const Eigen::Vector3d off =
        true_endpoint(machine, touched.samples.last()) - scenario.sets[0].places[i].p;
    EXPECT_LT(off.norm(), 1e-8) << i;  // six counts of 1e-9 rad at 1.3 m
    const Touched out = go(machine, MoveKind::retract, start);
    EXPECT_FALSE(machine.closed()) << i;
  }
}

}  // namespace
}  // namespace selfcal
