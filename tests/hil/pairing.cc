// The joint reading that is paired with a touch, against the robot's own truth at the kernel's
// stamp of the edge. Meant for deterministic guest time (tests/hil/machine --icount): elsewhere the
// host may take the processor away between two instructions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "app/service/front_end/sensor_front_end.h"
#include "io/can/encoders.h"
#include "io/can/faults.h"
#include "io/clock.h"
#include "io/gpio/trigger.h"
#include "tests/hil/spinning_arm.h"
#include "tests/support/cell.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

/// A robot that is never asked to move.
class NoMotion final : public Motion {
 public:
  Result<void> request(const MotionRequest&) override { return {}; }
  Result<void> stop(const std::string&) override { return {}; }
  Result<void> take(std::vector<MotionReply>&) override { return {}; }
};

/// Errors of the readings, in the time at each joint's speed (us); worst joint of each touch.
struct Pairs {
  std::vector<double> off_us;
  int unpaired = 0;
  std::uint64_t steps = 0;  ///< of the wall clock, made
  double of(double share) const {
    return off_us.at(static_cast<std::size_t>(share * static_cast<double>(off_us.size() - 1)));
  }
};

class Pairing : public InTheMachine {
 protected:
  /// The readings of `touches` edges; the wall clock is stepped forth and back every `step_every`
  /// touches, at any moment between two of them.
  Pairs pair(int touches, int step_every);
};

double off_us(const SpinningArm& arm, const EncoderSource& encoders, const Edge& edge,
              const std::pair<EncoderSample, EncoderSample>& around) {
  const Reading reading =
      reading_between(around.first, around.second, edge.time, encoders.scales());
  const Eigen::ArrayXd off = (reading.q - arm.truth().q(edge.time)).array().abs();
  // A count cannot be told from half of it.
  const double count = std::abs(encoders.scales()[0].step) / 2;
  return 1e6 * ((off - count).max(0) / arm.truth().dq(edge.time).array().abs()).maxCoeff();
}

std::uint64_t steps_noticed(const EncoderSource& encoders) {
  for (const Tally& tally : encoders.tallies())
    if (tally.name == to_string(CanFault::time_stepped)) return tally.count;
  return 0;
}

void print(const Pairs& pairs, const EncoderSource& encoders, const TouchTrigger& trigger) {
  if (pairs.off_us.empty()) return;
  std::string faults;
  for (const Tally& tally : encoders.tallies())
    if (tally.count > 0)
      faults += " " + std::string(tally.name) + " " + std::to_string(tally.count);
  std::printf(
      "%zu touches: median %.2f us, 99 %% %.2f us, worst %.2f us; %d without a reading; "
      "%llu samples and %llu edges dropped;%s\n",
      pairs.off_us.size(), pairs.of(0.5), pairs.of(0.99), pairs.of(1), pairs.unpaired,
      static_cast<unsigned long long>(encoders.dropped()),
      static_cast<unsigned long long>(trigger.dropped()), faults.c_str());
}

Pairs Pairing::pair(int touches, int step_every) {
  const SpinningArmOptions options;
  SpinningArm arm(wires, options);
  Wakeup wakeup, nobody;
  std::mt19937 random(1);
  SystemClock clock(wakeup);
  NoMotion motion;
  const auto encoders = must(CanEncoders::open(spinning_settings(wires.interface)));
  const auto trigger = must(GpioTrigger::open({.chip = wires.chip, .line = wires.line}, wakeup));
  const Ports ports{&clock, encoders.get(), trigger.get(), &motion, nullptr};
  Reflex reflex(ports, 2 * kMillisecond);
  SensorFrontEnd front_end(ports, reflex, Eigen::ArrayXd::Ones(kMostJoints), 1e-4, kSecond);
  Pairs pairs;
  std::deque<Edge> waiting;
  const Nanoseconds end = clock.now() + touches * 200 * kMillisecond;
  for (int made = 0; made < touches && clock.now() < end;) {
    clock.wait(2 * kMillisecond);
    std::deque<Event> events;
    front_end.listen(clock.now(), events);
    for (const Event& event : events)
      if (event.what == Event::What::closed && front_end.closing()) {
        waiting.push_back(*front_end.closing());
        front_end.forget_closing();
      }
    while (!waiting.empty()) {
      const Edge edge = waiting.front();
      const auto around = front_end.samples().around(edge.time);
      if (!around && clock.now() - edge.time < kSecond / 5) break;
      waiting.pop_front();
      ++made;
      if (!around || !edge.timed)
        ++pairs.unpaired;
      else
        pairs.off_us.push_back(off_us(arm, *encoders, edge, *around));
      if (made % step_every != 0) continue;
      nobody.wait(static_cast<Nanoseconds>(random() % static_cast<unsigned>(options.touch_every)));
      step_wall_clock(++pairs.steps % 2 == 1 ? 3600 * kSecond : -3600 * kSecond);
    }
  }
  EXPECT_TRUE(eventually(nobody, [&] { return steps_noticed(*encoders) >= pairs.steps; }));
  EXPECT_EQ(steps_noticed(*encoders), pairs.steps);
  std::ranges::sort(pairs.off_us);
  print(pairs, *encoders, *trigger);
  return pairs;
}

constexpr double kMost_us = 5;

TEST_F(Pairing, IsWithinFiveMicrosecondsOfTheTruthAndNeverAcrossAStepOfTheWallClock) {
  const int touches = repetitions("SELFCAL_TOUCHES", 2000), step_every = 100;
  const Pairs pairs = pair(touches, step_every);
  // Of each step one touch may have no reading, and is made again.
  ASSERT_GE(pairs.off_us.size(), static_cast<std::size_t>(touches - touches / step_every));
  EXPECT_EQ(pairs.steps, static_cast<std::uint64_t>(touches / step_every));
  EXPECT_LT(pairs.of(1), kMost_us);
}

}  // namespace
}  // namespace selfcal
