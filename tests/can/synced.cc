// Samples of joints that take their positions at SYNC, and each fault. Times in microseconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/can/bus.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPeriod = 10'000;
constexpr CanTiming kTiming = {.cycle = 0, .window = 0.005, .delay = 0};

class Synced : public testing::Test {
 protected:
  double t(int cycle) const { return 1e6 + kPeriod * cycle; }
  /// A cycle in which a stands at 1000 + 10 k and b at -1000 - 10 k.
  void good(int k) {
    bus.sync(t(k));
    bus.frame(0, 1000 + 10 * k, t(k) + 200);
    bus.frame(1, -1000 - 10 * k, t(k) + 400);
  }
  /// Good cycles from `first` to before `last`.
  void run(int first, int last) {
    for (int k = first; k < last; ++k) good(k);
  }
  /// Ends the last cycle.
  void end(int k) { bus.sync(t(k)); }

  Bus bus{two_joints(true), kTiming};
};

TEST_F(Synced, HaveTheTimeOfSyncAndComeWithTheNext) {
  good(0);
  EXPECT_THAT(bus.samples, IsEmpty());
  good(1);
  ASSERT_EQ(bus.samples.size(), 1u);
  EXPECT_EQ(bus.samples[0].time, 1'000'000'000);
  EXPECT_EQ(bus.samples[0].joints, 2);
  EXPECT_EQ(bus.samples[0].counts[0], 1000);
  EXPECT_EQ(bus.samples[0].counts[1], -1000);
  EXPECT_EQ(bus.others({}), 0u);
  EXPECT_EQ(bus.assembler.incomplete(), 0u);
}

TEST_F(Synced, DoNotCareInWhichOrderJointsAnswer) {
  good(0);
  bus.sync(t(1));
  bus.frame(1, -1010, t(1) + 200);
  bus.frame(0, 1010, t(1) + 400);
  end(2);
  EXPECT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.others({}), 0u);
}

TEST_F(Synced, AreSetBackByTheKnownDelay) {
  Bus late{two_joints(true), {.cycle = 0, .window = 0.005, .delay = 0.001}};
  late.sync(1e6);
  late.frame(0, 1, 1e6 + 100);
  late.frame(1, 2, 1e6 + 200);
  late.sync(1e6 + kPeriod);
  ASSERT_EQ(late.samples.size(), 1u);
  EXPECT_EQ(late.samples[0].time, 999'000'000);
}

TEST_F(Synced, LeaveFramesBeforeTheFirstSyncAlone) {
  bus.frame(0, 5, t(0) - 500);
  bus.frame(1, 5, t(0) - 400);
  run(0, 3);
  EXPECT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.samples[0].counts[0], 1000);
  EXPECT_EQ(bus.others({}), 0u);
}

TEST_F(Synced, AreNoneWhenAJointIsMissing) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 200);
  run(2, 4);
  ASSERT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.samples[1].time, static_cast<Nanoseconds>(t(2) * 1e3));
  EXPECT_EQ(bus.count(CanFault::missing), 1u);
  EXPECT_EQ(bus.others({CanFault::missing}), 0u);
  EXPECT_EQ(bus.assembler.incomplete(), 1u);
  EXPECT_THAT(bus.trouble(t(4)), IsEmpty());  // one in a hundred is no trouble
}

TEST_F(Synced, NameAJointThatStaysAway) {
  for (int k = 0; k < 5; ++k) {
    bus.sync(t(k));
    bus.frame(0, 1000, t(k) + 200);
  }
  EXPECT_THAT(bus.samples, IsEmpty());
  EXPECT_EQ(bus.trouble(t(5)), "can0: frames are missing (b (0x182))");
  EXPECT_THAT(bus.trouble(t(5) + 3e6), IsEmpty());
}

TEST_F(Synced, AreNoneWhenAJointIsLate) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 200);
  bus.frame(1, -1010, t(1) + 5100);
  run(2, 4);
  EXPECT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.count(CanFault::late), 1u);
  EXPECT_EQ(bus.others({CanFault::late}), 0u);
}

TEST_F(Synced, AreNoneWhenAFrameOfTheCycleBeforeComesAfterSync) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 200);
  bus.sync(t(2));
  bus.frame(1, -1010, t(2) + 50);  // of cycle 1
  bus.frame(0, 1020, t(2) + 200);
  bus.frame(1, -1020, t(2) + 400);
  run(3, 5);
  ASSERT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.samples[1].counts[1], -1030);
  EXPECT_EQ(bus.count(CanFault::missing), 1u);
  EXPECT_EQ(bus.count(CanFault::duplicated), 1u);
}

TEST_F(Synced, StandWhenAFrameIsRepeatedAsItWas) {
  good(0);
  good(1);
  bus.frame(1, -1010, t(1) + 600);
  end(2);
  EXPECT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.count(CanFault::duplicated), 1u);
  EXPECT_EQ(bus.others({CanFault::duplicated}), 0u);
}

TEST_F(Synced, AreNoneWhenFramesAreStampedBackwards) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 300);
  bus.frame(1, -1010, t(1) + 200);
  run(2, 4);
  EXPECT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.count(CanFault::out_of_order), 1u);
}

TEST_F(Synced, AreNoneWhenSyncWasLost) {
  run(0, 3);
  // The SYNC of cycle 3 is lost; its frames come all the same.
  bus.frame(0, 1030, t(3) + 200);
  bus.frame(1, -1030, t(3) + 400);
  run(4, 6);
  ASSERT_EQ(bus.samples.size(), 3u);  // 0, 1, 4: 2 is not known to be whole
  EXPECT_EQ(bus.samples[2].counts[0], 1040);
}

TEST_F(Synced, NeverMixTwoCyclesAroundALostSync) {
  Bus wide{two_joints(true), {.cycle = 0, .window = 0.05, .delay = 0}};
  for (int k = 0; k < 3; ++k) {
    wide.sync(t(k));
    wide.frame(0, k, t(k) + 200);
    if (k < 2) wide.frame(1, k, t(k) + 400);
  }
  wide.frame(1, 3, t(3) + 400);  // b of cycle 2 and SYNC of cycle 3 were lost
  wide.sync(t(4));
  EXPECT_EQ(wide.samples.size(), 2u);
}

TEST_F(Synced, SayThatSyncIsMissing) {
  for (int k = 0; k < 6; ++k) {
    bus.frame(0, 1000, t(k) + 200);
    bus.frame(1, 1000, t(k) + 400);
  }
  EXPECT_THAT(bus.samples, IsEmpty());
  EXPECT_EQ(bus.trouble(t(6)), "can0: frames are missing (SYNC)");
}

TEST_F(Synced, SayThatSyncStopped) {
  run(0, 3);
  for (int k = 6; k < 10; ++k) bus.frame(0, 1000, t(k) + 200);
  EXPECT_EQ(bus.trouble(t(10)), "can0: frames are missing (SYNC)");
}

TEST_F(Synced, AreNoneForACountThatJumpsAndGoOnFromThere) {
  good(0);
  // 10 rad/s in 10 ms are 0.1 rad: 100 000 counts.
  for (int k = 1; k < 4; ++k) {
    bus.sync(t(k));
    bus.frame(0, 1'000'000, t(k) + 200);
    bus.frame(1, -1010, t(k) + 400);
  }
  end(4);
  ASSERT_EQ(bus.samples.size(), 3u);
  EXPECT_EQ(bus.samples[1].time, static_cast<Nanoseconds>(t(2) * 1e3));
  EXPECT_EQ(bus.count(CanFault::jumped), 1u);
  EXPECT_EQ(bus.trouble(t(4)), "can0: a counter jumped (a)");
}

TEST_F(Synced, FollowTheFastestMotionThatIsAllowed) {
  for (int k = 0; k < 10; ++k) {
    bus.sync(t(k));
    bus.frame(0, 100'000 * k, t(k) + 200);
    bus.frame(1, 0, t(k) + 400);
  }
  EXPECT_EQ(bus.samples.size(), 9u);
  EXPECT_EQ(bus.count(CanFault::jumped), 0u);
}

TEST_F(Synced, KnowASecondSenderOfOneId) {
  for (int k = 0; k < 6; ++k) {
    good(k);
    bus.frame(1, 777, t(k) + 700);
  }
  EXPECT_THAT(bus.samples, IsEmpty());
  EXPECT_TRUE(bus.faults.lasts(CanFault::second_sender));
  EXPECT_THAT(bus.trouble(t(6)), HasSubstr("a second sender (b (0x182))"));
  run(6, 60);
  EXPECT_FALSE(bus.faults.lasts(CanFault::second_sender));
  EXPECT_EQ(bus.count(CanFault::second_sender), 1u);
  EXPECT_GT(bus.samples.size(), 20u);
}

TEST_F(Synced, TakeASecondSenderWithTheSameValuesForOneToo) {
  for (int k = 0; k < 6; ++k) {
    good(k);
    bus.frame(1, -1000 - 10 * k, t(k) + 700);
  }
  EXPECT_TRUE(bus.faults.lasts(CanFault::second_sender));
}

TEST_F(Synced, PutNothingTogetherAcrossFramesThatTheKernelLost) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 200);
  CanFrame b = encode(bus.map, bus.map.messages[1], {0, -1020});
  b.lost = 7;
  bus.add(b, t(2) + 400);
  run(3, 5);
  ASSERT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.samples[1].counts[0], 1030);
  EXPECT_EQ(bus.count(CanFault::overrun), 7u);
  EXPECT_EQ(bus.trouble(t(5)), "can0: frames were lost in the queue (7 frames)");
}

TEST_F(Synced, PutNothingTogetherAcrossAnInterruption) {
  good(0);
  bus.assembler.interrupt();
  bus.frame(0, 1010, t(1) + 200);
  run(2, 4);
  ASSERT_EQ(bus.samples.size(), 1u);
  EXPECT_EQ(bus.samples[0].counts[0], 1020);
  EXPECT_EQ(bus.others({}), 0u);
}

TEST_F(Synced, RefuseFramesThatAreNotAsTheMapSays) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1) + 200);
  CanFrame b = encode(bus.map, bus.map.messages[1], {0, -1010});
  b.size = 3;
  bus.add(b, t(1) + 400);
  bus.sync(t(2));
  bus.frame(0, 1020, t(2) + 200);
  b.size = 4;
  b.fd = true;
  bus.add(b, t(2) + 400);
  end(3);
  EXPECT_EQ(bus.samples.size(), 1u);
  EXPECT_EQ(bus.count(CanFault::malformed), 2u);
}

TEST_F(Synced, CountTurnsOnOverTheEndOfACounter) {
  CanMap map = two_joints(true);
  for (CanJoint& joint : map.joints) {
    joint.field = byte_field(0, 2, false, false);
    joint.wraps_at = 36000;
    joint.scale = {.step = 1e-4, .zero = 100};
  }
  ASSERT_EQ(map.finish(), std::nullopt);
  Bus wrapping{map, kTiming};
  // Up through 35999 and down through 0, 150 counts (15 mrad) in 10 ms. 35900 is nearest to the
  // zero at 100 as -100.
  for (int k = 0; k < 600; ++k) {
    wrapping.sync(t(k));
    wrapping.frame(0, 35900 + 150 * k, t(k) + 200);
    wrapping.frame(1, 200 - 150 * k, t(k) + 400);
  }
  ASSERT_EQ(wrapping.samples.size(), 599u);
  for (int k = 0; k < 599; ++k) {
    ASSERT_EQ(wrapping.samples[k].counts[0], -100 + 150 * k);
    ASSERT_EQ(wrapping.samples[k].counts[1], 200 - 150 * k);
  }
  EXPECT_EQ(wrapping.others({}), 0u);
}

TEST_F(Synced, SayThatTurnsMayHaveBeenMissed) {
  CanMap map = two_joints(true);
  map.joints[0].wraps_at = 1'000'000;  // half of it takes 50 ms at 10 rad/s
  ASSERT_EQ(map.finish(), std::nullopt);
  Bus wrapping{map, kTiming};
  for (const int k : {0, 1, 8, 9}) {
    wrapping.sync(t(k));
    wrapping.frame(0, 1, t(k) + 200);
    wrapping.frame(1, 1, t(k) + 400);
  }
  EXPECT_EQ(wrapping.count(CanFault::turns_unknown), 1u);
  EXPECT_THAT(wrapping.trouble(t(9)), HasSubstr("turns may have been missed (a)"));
}

}  // namespace
}  // namespace selfcal
