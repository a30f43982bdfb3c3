// The same joints: counts that jump or turn over, second senders, frames that were lost or are
// wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/can/synced.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Synced, AreNoneForACountThatJumpsAndGoOnWhereItWas) {
  good(0);
  bus.sync(t(1));
  bus.frame(0, 1'000'000, t(1) + 200);
  bus.frame(1, -1010, t(1) + 400);
  good(2);
  good(3);
  end(4);
  ASSERT_EQ(bus.samples.size(), 3u);
  EXPECT_EQ(bus.samples[1].time, static_cast<Nanoseconds>(t(2) * 1e3));
  EXPECT_EQ(bus.count(CanFault::jumped), 1u);
  EXPECT_EQ(bus.count(CanFault::zero_lost), 0u);
}

TEST_F(Synced, BelieveACountAfterAnInterruption) {
  good(0);
  good(1);
  bus.assembler.interrupt();
  for (int k = 2; k < 6; ++k) {
    bus.sync(t(k));
    bus.frame(0, 1'000'000, t(k) + 200);
    bus.frame(1, -1010, t(k) + 400);
  }
  EXPECT_EQ(bus.count(CanFault::jumped), 0u);
  EXPECT_EQ(bus.count(CanFault::zero_lost), 0u);
  ASSERT_EQ(bus.samples.size(), 4u);
  EXPECT_FALSE(bus.samples[1].follows);
  EXPECT_TRUE(bus.samples[2].follows);
}

TEST_F(Synced, EndWhereACountJumpsAndGoesOnFromThere) {
  good(0);
  // 10 rad/s in 10 ms are 0.1 rad: 100 000 counts.
  for (int k = 1; k < 4; ++k) {
    bus.sync(t(k));
    bus.frame(0, 1'000'000, t(k) + 200);
    bus.frame(1, -1010, t(k) + 400);
  }
  end(4);
  EXPECT_EQ(bus.samples.size(), 1u);
  EXPECT_EQ(bus.count(CanFault::jumped), 1u);
  EXPECT_EQ(bus.count(CanFault::zero_lost), 1u);
  EXPECT_THAT(bus.trouble(t(4)), HasSubstr("a counter jumped and stayed"));
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
  EXPECT_THAT(wrapping.trouble(t(9)), HasSubstr("turns may have been missed"));
  EXPECT_EQ(wrapping.samples.size(), 2u);
}

TEST_F(Synced, KnowTheTurnOfAJointWhoseLimitsLeaveNoOther) {
  CanMap map = two_joints(true);
  map.joints[0].wraps_at = 1'000'000;
  map.joints[0].within_one_turn = true;
  ASSERT_EQ(map.finish(), std::nullopt);
  Bus wrapping{map, kTiming};
  for (const int k : {0, 1, 8, 9}) {
    wrapping.sync(t(k));
    wrapping.frame(0, k < 5 ? 400'000 : 600'000, t(k) + 200);
    wrapping.frame(1, 1, t(k) + 400);
  }
  EXPECT_EQ(wrapping.count(CanFault::turns_unknown), 0u);
  ASSERT_EQ(wrapping.samples.size(), 3u);
  EXPECT_EQ(wrapping.samples[1].counts[0], 400'000);
  EXPECT_EQ(wrapping.samples[2].counts[0], -400'000);
}

}  // namespace
}  // namespace selfcal
