// The map of joints: bytes worked out by hand.
#include "io/can/map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/can/bus.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

std::vector<std::uint8_t> bytes(const CanFrame& frame) {
  return {frame.data.begin(), frame.data.begin() + frame.size};
}

TEST(CanMap, WritesAndReadsAJointByHand) {
  CanMap map = two_joints(false);
  map.joints[1].id = map.joints[0].id;
  map.joints[1].field = byte_field(4, 2, true, true);
  ASSERT_EQ(map.finish(), std::nullopt);
  ASSERT_EQ(map.messages.size(), 1u);

  const CanFrame frame = encode(map, map.messages[0], {-2, 0x1234});

  EXPECT_EQ(frame.id.value, 0x181u);
  EXPECT_EQ(bytes(frame), (std::vector<std::uint8_t>{0xfe, 0xff, 0xff, 0xff, 0x12, 0x34}));
  EXPECT_EQ(raw_counts(map.joints[0], frame), -2);
  EXPECT_EQ(raw_counts(map.joints[1], frame), 0x1234);
}

TEST(CanMap, GivesFdFramesASizeThatExists) {
  CanMap map = two_joints(false);
  for (CanJoint& joint : map.joints) {
    joint.id = {.value = 0x18ff0102, .extended = true};
    joint.fd = true;
  }
  map.joints[1].field = byte_field(13, 4, false, true);
  ASSERT_EQ(map.finish(), std::nullopt);

  const CanFrame frame = encode(map, map.messages[0], {1, 2});

  EXPECT_TRUE(frame.fd);
  EXPECT_EQ(frame.size, 20);  // 17 bytes: the next data length code is 20
  EXPECT_EQ(frame.data[13], 2);
  EXPECT_EQ(to_string(frame.id), "0x18ff0102x");
}

TEST(CanMap, LetsACounterBeginAnew) {
  CanMap map = two_joints(false);
  map.joints[0].field = byte_field(0, 2, false, false);
  map.joints[0].wraps_at = 36000;
  map.joints[1].field = byte_field(0, 2, false, true);
  map.joints[1].wraps_at = 36000;
  ASSERT_EQ(map.finish(), std::nullopt);

  const CanFrame a = encode(map, map.messages[0], {-1, 0});
  const CanFrame b = encode(map, map.messages[1], {0, 36000 + 18001});

  EXPECT_EQ(raw_counts(map.joints[0], a), 35999);
  EXPECT_EQ(raw_counts(map.joints[1], b), 18001 - 36000);
}

TEST(CanMap, RefusesWhatCannotBe) {
  CanMap beyond = two_joints(false);
  beyond.joints[1].field = byte_field(6, 4, false, true);
  EXPECT_THAT(*beyond.finish(), HasSubstr("joint b stands beyond"));

  CanMap mixed = two_joints(false);
  mixed.joints[1].id = mixed.joints[0].id;
  mixed.joints[1].fd = true;
  EXPECT_THAT(*mixed.finish(), HasSubstr("all FD or all classic"));

  CanMap sync = two_joints(true);
  sync.joints[0].id = *sync.sync;
  EXPECT_THAT(*sync.finish(), HasSubstr("id of SYNC"));
}

TEST(CanMap, TellsAnExtendedIdFromAStandardOneOfTheSameNumber) {
  CanMap map = two_joints(false);
  map.joints[1].id = {.value = 0x181, .extended = true};
  ASSERT_EQ(map.finish(), std::nullopt);
  EXPECT_EQ(map.messages.size(), 2u);
  EXPECT_EQ(map.find({.value = 0x181, .extended = true}), 1);
}

TEST(CanMap, CountsTheNearestToAReading) {
  EXPECT_EQ(counts_of({.step = -1e-3, .zero = 100}, 0.0016), 98);
}

}  // namespace
}  // namespace selfcal
