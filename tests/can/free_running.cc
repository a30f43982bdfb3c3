// Samples of joints that send whenever they like, and each fault. Times in microseconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/can/bus.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kCycle = 1000;
constexpr CanTiming kFreeRunning = {.cycle = 0.001, .window = 0.0016, .delay = 0};

class FreeRunningJoints : public testing::Test {
 protected:
  /// Where both joints stand: 2 rad/s and -1 rad/s.
  static std::int64_t a(double t) { return std::llround(2 * t); }
  static std::int64_t b(double t) { return std::llround(-t); }
  double t(int cycle) const { return 1e6 + kCycle * cycle; }
  void send_a(int k) { bus.frame(0, a(t(k)), t(k)); }
  void send_b(int k) { bus.frame(1, b(t(k) + 300), t(k) + 300); }
  void run(int first, int last) {
    for (int k = first; k < last; ++k) {
      send_a(k);
      send_b(k);
    }
  }
  /// All samples are true at their time, to a count of rounding.
  void expect_true() {
    for (const EncoderSample& sample : bus.samples) {
      const double at = static_cast<double>(sample.time) * 1e-3;
      EXPECT_NEAR(static_cast<double>(sample.counts[0]), static_cast<double>(a(at)), 1) << at;
      EXPECT_NEAR(static_cast<double>(sample.counts[1]), static_cast<double>(b(at)), 1) << at;
    }
  }

  Bus bus{two_joints(false), kFreeRunning};
};

TEST_F(FreeRunningJoints, AreInterpolatedToTheStampsOfTheFirst) {
  run(0, 10);
  // a of cycle 0 has no b before it; a of cycle 9 has its b after it.
  ASSERT_EQ(bus.samples.size(), 9u);
  EXPECT_EQ(bus.samples[0].time, static_cast<Nanoseconds>(t(1) * 1e3));
  expect_true();
  EXPECT_EQ(bus.others({}), 0u);
  EXPECT_EQ(bus.assembler.incomplete(), 0u);
}

TEST_F(FreeRunningJoints, StayWithinFiveMicrosecondsOfMotionWithJitteryFrames) {
  std::uint32_t random = 1;
  const auto jitter = [&] {
    random = random * 1664525u + 1013904223u;
    return 150.0 * random / 4294967296.0;
  };
  for (int k = 0; k < 2000; ++k) {
    const double ta = t(k) + jitter(), tb = t(k) + 300 + jitter();
    bus.frame(0, a(ta), ta);
    bus.frame(1, b(tb), tb);
  }
  EXPECT_EQ(bus.samples.size(), 1999u);
  expect_true();  // a count is 1 urad: what joint b moves in 1 us
  EXPECT_EQ(bus.others({}), 0u);
}

TEST_F(FreeRunningJoints, OfOneFrameNeedNoOther) {
  CanMap map = two_joints(false);
  map.joints[1].id = map.joints[0].id;
  map.joints[1].field = byte_field(4, 4, false, true);
  ASSERT_EQ(map.finish(), std::nullopt);
  Bus one{map, kFreeRunning};
  for (int k = 0; k < 5; ++k) one.add(encode(one.map, one.map.messages[0], {k, -k}), t(k));
  ASSERT_EQ(one.samples.size(), 4u);  // nothing is known of the first count
  EXPECT_EQ(one.samples[3].counts[0], 4);
  EXPECT_EQ(one.samples[3].counts[1], -4);
}

TEST_F(FreeRunningJoints, AreNoSampleAroundAFrameThatIsMissing) {
  run(0, 5);
  send_a(5);
  run(6, 10);
  // Those at 5 and 6 lie between b of 4 and b of 6.
  ASSERT_EQ(bus.samples.size(), 7u);
  expect_true();
  EXPECT_EQ(bus.count(CanFault::missing), 1u);
  EXPECT_EQ(bus.others({CanFault::missing}), 0u);
  EXPECT_EQ(bus.assembler.incomplete(), 2u);
  EXPECT_THAT(bus.trouble(t(10)), IsEmpty());
}

TEST_F(FreeRunningJoints, AreNoSampleAroundAFrameThatIsLate) {
  run(0, 5);
  send_a(5);
  bus.frame(1, b(t(5) + 950), t(5) + 950);
  run(6, 10);
  EXPECT_EQ(bus.count(CanFault::late), 1u);
  EXPECT_EQ(bus.others({CanFault::late}), 0u);
  expect_true();
}

TEST_F(FreeRunningJoints, NameAJointThatStaysAway) {
  run(0, 5);
  for (int k = 5; k < 20; ++k) send_a(k);
  EXPECT_EQ(bus.trouble(t(20)), "can0: frames are missing (b (0x182))");
  EXPECT_EQ(bus.samples.size(), 4u);
  EXPECT_NEAR(static_cast<double>(bus.count(CanFault::missing)), 14, 1);
}

TEST_F(FreeRunningJoints, NameTheFirstJointToo) {
  run(0, 5);
  for (int k = 5; k < 20; ++k) send_b(k);
  EXPECT_EQ(bus.trouble(t(20)), "can0: frames are missing (a (0x181))");
}

TEST_F(FreeRunningJoints, NameAJointThatNeverCame) {
  for (int k = 0; k < 20; ++k) send_a(k);
  EXPECT_EQ(bus.trouble(t(20)), "can0: frames are missing (b (0x182))");
  EXPECT_THAT(bus.samples, IsEmpty());
}

TEST_F(FreeRunningJoints, PassOverAFrameThatIsRepeated) {
  run(0, 5);
  bus.frame(1, b(t(4) + 300), t(4) + 350);
  run(5, 10);
  EXPECT_EQ(bus.samples.size(), 9u);
  expect_true();
  EXPECT_EQ(bus.count(CanFault::duplicated), 1u);
  EXPECT_EQ(bus.others({CanFault::duplicated}), 0u);
}

TEST_F(FreeRunningJoints, AreNoSampleBetweenTwoValuesOfOneMoment) {
  run(0, 5);
  bus.frame(1, 5'000'000, t(4) + 350);
  run(5, 10);
  EXPECT_EQ(bus.samples.size(), 8u);
  expect_true();
}

TEST_F(FreeRunningJoints, PassOverFramesThatAreStampedBackwards) {
  run(0, 5);
  bus.frame(1, b(t(3)), t(3));
  run(5, 10);
  EXPECT_EQ(bus.samples.size(), 9u);
  expect_true();
  EXPECT_EQ(bus.count(CanFault::out_of_order), 1u);
}

TEST_F(FreeRunningJoints, AreNoSampleAcrossACountThatJumps) {
  run(0, 5);
  send_a(5);
  bus.frame(1, 9'000'000, t(5) + 300);
  run(6, 12);
  // Neither the way there nor the way back: 5 and 6 are none.
  EXPECT_EQ(bus.samples.size(), 9u);
  expect_true();
  EXPECT_EQ(bus.count(CanFault::jumped), 1u);
  EXPECT_EQ(bus.trouble(t(12)), "can0: a counter jumped (b)");
}

TEST_F(FreeRunningJoints, DoNotBecomeAFirstJointThatJumped) {
  run(0, 5);
  bus.frame(0, 9'000'000, t(5));
  send_b(5);
  run(6, 12);
  EXPECT_EQ(bus.samples.size(), 9u);
  expect_true();
}

// The two may be apart by any part of the cycle.
class SecondSender : public FreeRunningJoints, public testing::WithParamInterface<double> {};

TEST_P(SecondSender, OfOneIdIsKnownWithinTenCycles) {
  run(0, 50);
  for (int k = 50; k < 60; ++k) {
    send_a(k);
    const double first = t(k) + 300, second = first + GetParam() * kCycle;
    bus.frame(1, b(first), first);
    if (second > t(k + 1)) send_a(k + 1);
    bus.frame(1, b(second) + 5000, second);
    if (second > t(k + 1)) ++k;
  }
  EXPECT_TRUE(bus.faults.lasts(CanFault::second_sender));
  EXPECT_THAT(bus.trouble(t(60)), HasSubstr("a second sender (b (0x182))"));
}

INSTANTIATE_TEST_SUITE_P(Phases, SecondSender, testing::Values(0.02, 0.1, 0.24, 0.3, 0.5, 0.65));

TEST_F(FreeRunningJoints, GiveNoSampleWhileThereIsASecondSender) {
  for (int k = 0; k < 30; ++k) {
    send_a(k);
    send_b(k);
    bus.frame(1, b(t(k) + 800) + 5000, t(k) + 800);
  }
  const std::size_t known = bus.samples.size();
  EXPECT_LE(known, 8u);
  run(30, 100);
  EXPECT_FALSE(bus.faults.lasts(CanFault::second_sender));
  EXPECT_GT(bus.samples.size(), known + 30);
}

TEST_F(FreeRunningJoints, PutNothingTogetherAcrossAnInterruption) {
  run(0, 5);
  send_a(5);
  bus.assembler.interrupt();
  // The joints moved on; the pause is no fault of theirs.
  run(40, 45);
  expect_true();
  EXPECT_EQ(bus.others({}), 0u);
  EXPECT_EQ(bus.samples.size(), 4u + 4u);
}

TEST_F(FreeRunningJoints, PutNothingTogetherAcrossFramesThatTheKernelLost) {
  run(0, 5);
  CanFrame frame = encode(bus.map, bus.map.messages[0], {a(t(5)), 0});
  frame.lost = 3;
  bus.add(frame, t(5));
  send_b(5);
  run(6, 8);
  expect_true();
  EXPECT_EQ(bus.count(CanFault::overrun), 3u);
  EXPECT_EQ(bus.samples.size(), 6u);  // 1 to 4, 6, 7
}

TEST_F(FreeRunningJoints, CountTurnsOnWhileInterpolating) {
  CanMap map = two_joints(false);
  for (CanJoint& joint : map.joints) joint.wraps_at = 100'000;
  ASSERT_EQ(map.finish(), std::nullopt);
  Bus wrapping{map, kFreeRunning};
  for (int k = 0; k < 200; ++k) {
    wrapping.frame(0, 2000 * k, t(k));
    wrapping.frame(1, -1000 * k, t(k) + 500);
  }
  ASSERT_EQ(wrapping.samples.size(), 199u);
  for (int k = 1; k < 200; ++k) {
    ASSERT_EQ(wrapping.samples[k - 1].counts[0], 2000 * k);
    ASSERT_EQ(wrapping.samples[k - 1].counts[1], -1000 * k + 500);
  }
}

}  // namespace
}  // namespace selfcal
