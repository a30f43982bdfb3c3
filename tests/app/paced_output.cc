// What a simulated robot sends is true at the moment at which it is sent.
#include "app/commands/support/paced_output.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/sim/machine_cell.h"

namespace selfcal {
namespace {

/// Time that passes with every look at it, and a sleep that ends late.
class LateClock : public Clock {
 public:
  Nanoseconds now() override {
    if (away_every > 0 && random_() % away_every == 0)
      time_ += static_cast<Nanoseconds>(random_() % 3'000'000);
    return time_ += 300;
  }
  std::int64_t unix_ms() override { return 0; }
  void wait(Nanoseconds longest) override {
    if (longest > 0) time_ += longest + 60'000;
  }
  Nanoseconds last() const { return time_; }
  void pass(Nanoseconds t) { time_ += t; }

  unsigned away_every = 0;  ///< looks, on average: for up to 3 ms the processor does something else

 private:
  std::mt19937 random_{1};
  Nanoseconds time_ = 5 * kSecond;
};

struct SentJoints : JointSender {
  explicit SentJoints(LateClock& c) : clock(c) {}
  Result<void> send(Nanoseconds, const std::vector<double>& q) override {
    at.push_back(clock.last());
    readings.push_back(Eigen::Map<const Eigen::VectorXd>(q.data(), 6));
    clock.pass(120'000);  // six frames
    return {};
  }
  LateClock& clock;
  std::vector<Nanoseconds> at;
  std::vector<Eigen::VectorXd> readings;
};

struct SentTrigger : TriggerSender {
  explicit SentTrigger(LateClock& c) : clock(c) {}
  Result<void> send(Nanoseconds stamp, bool closed) override {
    edges.push_back({clock.last(), closed});
    due.push_back(stamp);
    clock.pass(5'000);
    return {};
  }
  LateClock& clock;
  std::vector<Edge> edges;
  std::vector<Nanoseconds> due;
};

/// A bus with SYNC, which comes a little after it was asked for, or late.
struct Synced : SentJoints {
  using SentJoints::SentJoints;
  bool marks() const override { return true; }
  Result<std::optional<Nanoseconds>> mark(Nanoseconds longest) override {
    clock.pass(std::min<Nanoseconds>(longest, 40'000));
    if (++asked % 3 == 0) return std::optional<Nanoseconds>();
    marked = clock.last() - 7'000;
    return std::optional(marked);
  }
  Result<void> send(Nanoseconds stamp, const std::vector<double>& q) override {
    auto sent = SentJoints::send(stamp, q);
    at.back() = marked;
    return sent;
  }
  int asked = 0;
  Nanoseconds marked = 0;
};

class Paced : public testing::Test {
 protected:
  void play(PacedOutput& output, Nanoseconds length) {
    for (const Nanoseconds end = clock.last() + length; clock.last() < end;)
      ASSERT_TRUE(output.turn());
  }
  LateClock clock;
  SentJoints joints{clock};
  SentTrigger trigger{clock};
};

TEST_F(Paced, SendsThePositionsOfTheMomentOfSending) {
  Machine machine = machine_of(table());
  PacedOutput output(machine, joints, trigger, clock);
  const Nanoseconds began = clock.last();
  play(output, 10 * kMillisecond);
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, "a", 2));
  joints.at.clear();
  joints.readings.clear();
  play(output, 100 * kMillisecond);
  ASSERT_NEAR(static_cast<double>(joints.at.size()), 50, 3) << "one every 2 ms";
  for (std::size_t i = 0; i < joints.at.size(); ++i) {
    const Eigen::VectorXd there = machine.readings(joints.at[i] - began);
    // 1 us at 2 rad/s: looks at the clock, the first of them too few to know how long it takes.
    EXPECT_LT((joints.readings[i] - there).cwiseAbs().maxCoeff(), 2 * 1e-6) << i;
  }
}

TEST_F(Paced, TakesThePositionsAtTheMarkThatTheBusGives) {
  Machine machine = machine_of(table());
  Synced synced(clock);
  PacedOutput output(machine, synced, trigger, clock);
  const Nanoseconds began = clock.last();
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, "a", 2));
  play(output, 100 * kMillisecond);
  ASSERT_NEAR(static_cast<double>(synced.at.size()), 50, 3) << "a mark that is late is awaited";
  for (std::size_t i = 0; i < synced.at.size(); ++i)
    // Half a count of 1e-9 rad: the moment is known exactly.
    EXPECT_LT((synced.readings[i] - machine.readings(synced.at[i] - began)).cwiseAbs().maxCoeff(),
              1e-9)
        << i;
}

TEST_F(Paced, DrivesEveryEdgeAtItsMomentThoughSleepsEndLateAndFramesTakeTime) {
  Machine machine = machine_of(table("trigger_delay: 0.0005, bounce: 1"));
  PacedOutput output(machine, joints, trigger, clock);
  const Nanoseconds began = clock.last();
  for (int i = 0; i < 10; ++i) {
    for (const Eigen::VectorXd& q : {home(), planned_touches()[i].start}) {
      machine.request(request_of(MoveKind::travel, q, "to"));
      while (machine.moving()) ASSERT_TRUE(output.turn());
    }
    machine.request(request_of(MoveKind::touch, planned_touches()[i].end, std::to_string(i)));
    while (machine.moving() && !machine.closed()) ASSERT_TRUE(output.turn());
    machine.stop("touched");
    play(output, 20 * kMillisecond);
    machine.request(request_of(MoveKind::retract, planned_touches()[i].start, "out"));
    while (machine.moving()) ASSERT_TRUE(output.turn());
  }
  ASSERT_EQ(trigger.edges.size(), 60u) << "in and out, each with one bounce";
  for (std::size_t i = 0; i < trigger.edges.size(); ++i) {
    const Nanoseconds late = trigger.edges[i].time - began - trigger.due[i];
    EXPECT_GE(late, 0) << i;
    EXPECT_LT(late, 5'000) << i << ": a few looks at the clock";
    EXPECT_EQ(trigger.edges[i].closed, i % 2 == 0);
  }
}

TEST_F(Paced, LetsTheMachineStandStillWhileTheProcessorIsAway) {
  constexpr Nanoseconds kDelay = kSecond / 2000;
  Machine machine = machine_of(table("trigger_delay: 0.0005, bounce: 1"));
  Synced synced(clock);
  PacedOutput output(machine, synced, trigger, clock);
  clock.away_every = 1000;
  int hit = 0;
  double worst = 0;  // s of the joint's way
  for (int i = 0; i < 60; ++i) {
    const PlannedTouch& touch = planned_touches()[i % 20];
    for (const Eigen::VectorXd& q : {home(), touch.start}) {
      machine.request(request_of(MoveKind::travel, q, "to"));
      while (machine.moving()) ASSERT_TRUE(output.turn());
    }
    trigger.edges.clear();
    trigger.due.clear();
    machine.request(request_of(MoveKind::touch, touch.end, std::to_string(i)));
    while (machine.moving() && trigger.edges.empty()) ASSERT_TRUE(output.turn());
    ASSERT_FALSE(trigger.edges.empty());
    const Eigen::VectorXd contact = machine.readings(trigger.due[0] - kDelay);
    play(output, 4 * kMillisecond);
    SampleHistory history;
    for (std::size_t k = synced.at.size() - 20; k < synced.at.size(); ++k) {
      EncoderSample sample;
      sample.time = synced.at[k];
      sample.joints = 6;
      for (int j = 0; j < 6; ++j) sample.counts[j] = std::llround(synced.readings[k][j] / 1e-9);
      history.add(sample);
    }
    const DrivenEdge edge =
        *std::ranges::find(output.driven(), std::to_string(i), &DrivenEdge::label);
    machine.stop("touched");
    play(output, 20 * kMillisecond);
    machine.request(request_of(MoveKind::retract, touch.start, "out"));
    while (machine.moving()) ASSERT_TRUE(output.turn());
    const auto around = history.around(edge.before - kDelay);
    // Between the last look at the clock and the driving nothing can be done about it; and the
    // frame after the edge may come too late.
    if (edge.late > 5'000 || !around) continue;
    ++hit;
    const Reading reading =
        reading_between(around->first, around->second, edge.before - kDelay, machine.scales());
    worst = std::max(
        worst, (reading.q - contact).cwiseAbs().maxCoeff() / reading.dq.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(output.pauses(), 10) << "else nothing was shown";
  EXPECT_GE(hit, 50);
  EXPECT_LT(worst, 5e-6);
}

TEST_F(Paced, KeepsTheTruthOfEveryEdge) {
  Machine machine = machine_of(table("trigger_delay: 0.0005"));
  PacedOutput output(machine, joints, trigger, clock);
  const Nanoseconds began = clock.last();
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, "to"));
  while (machine.moving()) ASSERT_TRUE(output.turn());
  machine.request(request_of(MoveKind::touch, planned_touches()[0].end, "7/3.0 table"));
  while (output.driven().empty()) ASSERT_TRUE(output.turn());
  const DrivenEdge& edge = output.driven().front();
  EXPECT_TRUE(edge.closed);
  EXPECT_EQ(edge.label, "7/3.0 table");
  EXPECT_GE(edge.after - edge.before, 5'000);
  const Nanoseconds contact = edge.before - began - kSecond / 2000;
  EXPECT_EQ(edge.q, machine.readings(contact));
  const Eigen::VectorXd later = machine.readings(contact + kMillisecond);
  // The speed is steady over a millisecond of a slow approach; a double's rounding over 2 us.
  EXPECT_LT((edge.q + 1e-3 * edge.dq - later).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(edge.dq.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_EQ(driven_text(output.driven()).find("{\"closed\":true,\"before_ns\":"), 0u);
}

TEST_F(Paced, HasAnEdgeOfTheMachineAnnouncedBeforeItComes) {
  Machine machine = machine_of(table("trigger_delay: 0.0005"));
  EXPECT_FALSE(machine.next_edge());
  EXPECT_EQ(machine.next_sample(), 2 * kMillisecond);
  machine.request(request_of(MoveKind::travel, planned_touches()[0].start, "to"));
  while (machine.moving()) machine.advance(machine.now() + kMillisecond);
  machine.request(request_of(MoveKind::touch, planned_touches()[0].end, "a"));
  const auto announced = machine.next_edge();
  ASSERT_TRUE(announced);
  machine.advance(*announced - kSecond / 2000 - 1);
  std::vector<Edge> edges;
  machine.take(edges);
  EXPECT_TRUE(edges.empty());
  machine.advance(*announced - kSecond / 2000);
  machine.take(edges);
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges[0].time, *announced);
}

}  // namespace
}  // namespace selfcal
