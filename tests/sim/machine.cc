// A touch of the simulated robot happens where its true endpoint meets the true surface.
#include "sim/machine.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "kinematics/corrected_robot.h"
#include "tests/sim/machine_cell.h"

namespace selfcal {
namespace {

// A path of 80 mm is narrowed down to 80 mm / (4 * 31 * 31^3) = 2e-8 m; a moment of 1 ns and a
// count of 1e-9 rad are less.
constexpr double kPlace = 1e-7;  // m

TEST(Machine, TouchesWhereTheTrueEndpointMeetsTheTrueSurface) {
  Machine machine = machine_of(table());
  for (std::size_t i = 0; i < planned_touches().size(); ++i) {
    const Touched touched = touch(machine, planned_touches()[i], std::to_string(i));
    ASSERT_TRUE(touched.closing) << i;
    EXPECT_NEAR(height(machine, touched, *touched.closing), 0, kPlace) << i;
    go(machine, MoveKind::retract, planned_touches()[i].start);
  }
}

TEST(Machine, TellsTheEdgeLaterByTheTriggersDelay) {
  Machine machine = machine_of(table("trigger_delay: 0.0005"));
  const Touched touched = touch(machine, planned_touches()[0], "a");
  ASSERT_TRUE(touched.closing);
  EXPECT_NEAR(height(machine, touched, *touched.closing - kSecond / 2000), 0, kPlace);
  EXPECT_LT(height(machine, touched, *touched.closing), -2 * kPlace) << "it moved on";
}

TEST(Machine, IsOffByItsNoiseAndByTheSameOneForTheSameLabel) {
  const std::string noise = "2.0e-5";
  Machine machine = machine_of(table("", "", noise)), again = machine_of(table("", "", noise));
  const PlannedTouch& planned = planned_touches()[0];
  double sum = 0;
  constexpr int kTouches = 100;
  for (int i = 0; i < kTouches; ++i) {
    const Touched touched = touch(machine, planned, "t" + std::to_string(i));
    ASSERT_TRUE(touched.closing);
    const double off = height(machine, touched, *touched.closing);
    sum += off * off;
    go(machine, MoveKind::retract, planned.start);
    if (i % 10 != 0) continue;
    const Touched same = touch(again, planned, "t" + std::to_string(i));
    EXPECT_NEAR(height(again, same, *same.closing), off, 2 * kPlace) << i;
    go(again, MoveKind::retract, planned.start);
  }
  // The rms of n normal draws scatters by sigma / sqrt(2 n): 7 %, 3 sigma of it 21 %.
  EXPECT_NEAR(std::sqrt(sum / kTouches), 2e-5, 0.21 * 2e-5);
}

TEST(Machine, StopsInTheContactAndOpensTheTriggerOnTheWayOut) {
  Machine machine = machine_of(table());
  const PlannedTouch& planned = planned_touches()[0];
  const Touched in = touch(machine, planned, "a");
  EXPECT_TRUE(machine.closed());
  const EncoderSample at_rest = in.samples.last();
  Touched still;
  pass(machine, kSecond, still);
  EXPECT_EQ(still.samples.last().counts, at_rest.counts) << "it stands";
  Touched out = go(machine, MoveKind::retract, planned.start);
  EXPECT_FALSE(machine.closed());
  ASSERT_EQ(out.edges.size(), 1u);
  EXPECT_FALSE(out.edges[0].closed);
  EXPECT_NEAR(height(machine, out, out.edges[0].time), 0, kPlace) << "where it had closed";
}

TEST(Machine, BouncesAsOftenAsItIsToldAndEndsClosed) {
  Machine machine = machine_of(table("bounce: 3"));
  const Touched touched = touch(machine, planned_touches()[0], "a");
  ASSERT_EQ(touched.edges.size(), 7u);
  for (std::size_t i = 0; i < touched.edges.size(); ++i) {
    EXPECT_EQ(touched.edges[i].closed, i % 2 == 0);
    EXPECT_TRUE(i == 0 || touched.edges[i].time > touched.edges[i - 1].time);
  }
  EXPECT_LT(touched.edges.back().time - touched.edges.front().time, kMillisecond);
  EXPECT_NEAR(height(machine, touched, *touched.closing), 0, kPlace) << "the first edge counts";
}

TEST(Machine, MissesAndMistakesTheShareOfTouchesThatItIsTold) {
  Machine machine = machine_of(
      table("missed: 0.1, speed: 50, acceleration: 5000", "false_triggers: {share: 0.2}\n"));
  const PlannedTouch& planned = planned_touches()[0];
  constexpr int kTouches = 1000;
  int missed = 0, early = 0;
  go(machine, MoveKind::travel, planned.start);
  for (int i = 0; i < kTouches; ++i) {
    const std::size_t before = machine.false_touches().size();
    Touched touched;
    machine.request(request_of(MoveKind::touch, planned.end, "t" + std::to_string(i)));
    pass(machine, 3 * kSecond / 2, touched);
    missed += !touched.closing;
    if (touched.closing && i < 100) {
      const double off = height(machine, touched, *touched.closing);
      const bool is_early = machine.false_touches().size() > before;
      EXPECT_GE(off, is_early ? 1e-3 - kPlace : -kPlace) << "false ones are 1 to 8 mm early";
      EXPECT_LE(off, is_early ? 8e-3 + kPlace : kPlace);
    }
    early += machine.false_touches().size() > before;
    machine.request(request_of(MoveKind::retract, planned.start, "", 10));
    pass(machine, kSecond / 2, touched);
    ASSERT_FALSE(machine.closed()) << i;
  }
  const auto three_sigma = [](double share) {  // binomial
    return 3 * std::sqrt(kTouches * share * (1 - share));
  };
  EXPECT_NEAR(missed, kTouches * 0.1, three_sigma(0.1));
  EXPECT_NEAR(early, kTouches * 0.9 * 0.2, three_sigma(0.18)) << "of those that are not missed";
  EXPECT_EQ(machine.visits().size(), static_cast<std::size_t>(kTouches));
  EXPECT_EQ(machine.visits().at("t17"), 1);
}

TEST(Machine, GivesItsSamplesRegularlyWithinItsSpeedAndOnlyTheLastOnes) {
  Machine machine = machine_of(table("encoder_period: 0.004, speed: 1.5"));
  machine.request(request_of(MoveKind::travel, planned_touches()[3].start, "", 10));
  std::vector<EncoderSample> samples;
  for (int i = 0; i < 300; ++i) {
    machine.advance(machine.now() + 7 * kMillisecond);
    machine.take(samples);
  }
  ASSERT_EQ(samples.size(), 2100u / 4);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].time - samples[i - 1].time, 4 * kMillisecond);
    for (int j = 0; j < 6; ++j)  // 1.5 rad/s over 4 ms and half a count (1e-9 rad) at each end
      ASSERT_LE(std::abs(samples[i].counts[j] - samples[i - 1].counts[j]), 6'000'000 + 1);
  }
  samples.clear();
  machine.advance(machine.now() + 1000 * kSecond);
  machine.take(samples);
  EXPECT_LE(samples.size(), EncoderSource::kMostSamples);
  EXPECT_EQ(machine.now() - samples.back().time, machine.now() % (4 * kMillisecond));
}

TEST(Machine, AnswersEachRequestWithWhatCameOfIt) {
  Machine machine = machine_of(table());
  std::vector<MotionReply> replies;
  const auto outcomes = [&] {
    replies.clear();
    machine.take(replies);
    std::string names;
    for (const MotionReply& reply : replies) names += std::string(to_string(reply.outcome)) + " ";
    return names;
  };
  go(machine, MoveKind::travel, planned_touches()[0].start);
  EXPECT_EQ(outcomes(), "accepted done ");
  machine.request(request_of(MoveKind::travel, home(), ""));
  machine.advance(machine.now() + kSecond / 10);
  machine.stop("enough");
  EXPECT_EQ(outcomes(), "accepted stopped ");
  EXPECT_EQ(replies.back().why, "enough");
  machine.stop("again");
  EXPECT_EQ(outcomes(), "") << "nothing moves";
  Eigen::VectorXd far = home();
  far[0] = 3;  // the limit is 2.79
  machine.request(request_of(MoveKind::travel, far, ""));
  EXPECT_EQ(outcomes(), "refused ");
  EXPECT_THAT(replies[0].why, testing::HasSubstr("j1 cannot go to 3"));
  machine.request(request_of(MoveKind::travel, home().head(3), ""));
  EXPECT_EQ(outcomes(), "refused ");
}

// ------------------------------------------------------------------- what the model lacks

TEST(Machine, IsAsItsFileHasItAtTheTemperatureOfItsStart) {
  for (const char* warming : {"0", "10"}) {
    const Machine machine = machine_of(
        table("temperature: 35, warming: " + std::string(warming) +
              ", effects: [{effect: thermal_expansion, alpha: 1.2e-5}, {effect: thermal_expansion, "
              "lag: 600, reference: 20, alpha: 1.2e-5}]"));
    const std::vector<Node> effects = effect_entries(machine.robot());
    ASSERT_EQ(effects.size(), 2U);
    EXPECT_EQ(effects[0].find("reference")->text, "35") << warming;
    EXPECT_EQ(effects[1].find("reference")->text, "20") << warming;
  }
}

/// Height of the end position at a moment, as the model without effects has it (m).
double height_of_model(const Machine& plain, const Eigen::VectorXd& readings) {
  return locate(plain.robot(), plain.truth().xi, readings).p.z();
}

TEST(MachineEffects, HaveAZeroSlipped) {
  Machine plain = machine_of(table());
  Machine slipped =
      machine_of(table("effects: [{effect: zero_shift, at: j2, moment: 0, step: 1.0e-3}]"));
  const auto at_contact = [&](Machine& machine) {
    const Touched touched = touch(machine, planned_touches()[0], "a");
    return machine.readings(*touched.closing);
  };
  const Eigen::VectorXd readings = at_contact(slipped);
  Eigen::VectorXd joints = readings;
  joints[1] += 1e-3;
  const double table = height_of_model(plain, at_contact(plain));
  EXPECT_NEAR(height_of_model(plain, joints), table, 2e-5) << "the table is 4 mrad off level";
  EXPECT_GT(std::abs(height_of_model(plain, readings) - table), 2e-4);
}

// The joint stands half its play behind the reading, seen in the way it came: the model, which goes
// by the reading, takes the contact for where the joint would have gone on to.
TEST(MachineEffects, ShowPlayByTheSideOfTheApproach) {
  constexpr int kJoint = 2;
  constexpr double kHalf = 1e-3, kStep = 1e-4;
  Machine plain = machine_of(table());
  Machine with = machine_of(table("effects: [{effect: backlash, at: j3, play: 2.0e-3}]"));
  double most = 0;
  for (const PlannedTouch& planned : planned_touches()) {
    const Touched a = touch(plain, planned, "t"), b = touch(with, planned, "t");
    ASSERT_TRUE(a.closing && b.closing);
    const Eigen::VectorXd q = plain.readings(*a.closing);
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(q.size(), kJoint);
    const double lifts =
        (height_of_model(plain, q + step) - height_of_model(plain, q - step)) / (2 * kStep);
    const double side = planned.end[kJoint] > planned.start[kJoint] ? 1 : -1;
    EXPECT_NEAR(height_of_model(plain, with.readings(*b.closing)) - height_of_model(plain, q),
                side * kHalf * lifts, 2e-5)
        << "the table is 4 mrad off level";
    most = std::max(most, std::abs(kHalf * lifts));
    go(plain, MoveKind::retract, planned.start);
    go(with, MoveKind::retract, planned.start);
  }
  EXPECT_GT(most, 2e-4) << "of 1 mrad at an arm of some 0.5 m";
}

TEST(MachineEffects, AreRefusedWhereTheRobotCannotHaveThem) {
  Problems problems;
  const Machine machine(table("effects: [{effect: backlash, at: j9, play: 1.0e-3}]"),
                        {std::shared_ptr<void>(), &rx90()}, home(), problems);
  ASSERT_TRUE(problems.any());
  EXPECT_NE(problems.list.front().find("j9"), std::string::npos) << problems.list.front();
}

}  // namespace
}  // namespace selfcal
