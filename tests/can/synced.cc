// Samples of joints that take their positions at SYNC: when they are complete and when there is
// none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/can/synced.h"

namespace selfcal {
namespace {

using testing::IsEmpty;

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

TEST_F(Synced, AreNoneOfACycleThatBeginsTwiceAtOnce) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1010, t(1));
  bus.frame(1, -1010, t(1));
  bus.sync(t(1));
  run(2, 4);
  ASSERT_EQ(bus.samples.size(), 2u);
  EXPECT_EQ(bus.samples[0].time, 1'000'000'000);
  EXPECT_EQ(bus.samples[1].time, 1'020'000'000);
  EXPECT_EQ(bus.count(CanFault::duplicated), 1u);
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

}  // namespace
}  // namespace selfcal
