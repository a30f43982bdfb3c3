// A touch without a stamp as the service's trigger.
#include "app/bridge/touch_relay.h"

#include <gtest/gtest.h>

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/senders.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class Touched : public DdsTest {};

TEST_F(Touched, BecomesTheTriggerWithTheMomentAtWhichItWasWritten) {
  auto relay = must(TouchRelay::open(
      participant, "/touch", must(DdsTriggerSender::open(participant, "trigger", wakeup)), wakeup));
  auto levels =
      must(DdsReader<dds::StampedBool>::open(participant, ros_topic("trigger"), kExchange));
  std::optional<DdsWriter<dds::Bool>> touch =
      must(DdsWriter<dds::Bool>::open(participant, ros_topic("touch"), {}, &wakeup));
  ASSERT_TRUE(eventually(
      [&] { return levels.matched() == 1 && relay->publishers() == 1 && touch->matched() == 1; }));
  std::vector<std::pair<Nanoseconds, bool>> heard;
  const auto hear = [&] {
    must(relay->turn(monotonic_now()));
    must(levels.take([&](const dds::StampedBool& level) {
      heard.emplace_back(nanoseconds(level.header_.stamp_), level.data_);
    }));
  };
  const dds::Bool open{false}, closed{true};
  ASSERT_EQ(dds_write_ts(touch->handle(), &open, 5 * kSecond), 0);
  ASSERT_EQ(dds_write_ts(touch->handle(), &closed, 6 * kSecond + 7), 0);
  ASSERT_EQ(dds_write_ts(touch->handle(), &closed, 8 * kSecond), 0);
  ASSERT_TRUE(eventually([&] {
    hear();
    return heard.size() >= 4;
  })) << "repeated";
  EXPECT_EQ(heard[0], std::pair(5 * kSecond, false));
  EXPECT_EQ(heard[1], std::pair(6 * kSecond + 7, true));
  EXPECT_EQ(heard[2], heard[1]) << "a repetition has the stamp of its change";

  touch.reset();
  ASSERT_TRUE(eventually([&] {
    hear();
    return relay->publishers() == 0;
  }));
  heard.clear();
  const Nanoseconds since = monotonic_now();
  ASSERT_TRUE(eventually([&] {
    hear();
    return monotonic_now() - since > 3 * kSecond / 10;
  }));
  EXPECT_LE(heard.size(), 1) << "nobody knows the level any more";
}

TEST_F(Touched, IsNotRepeatedForADriverThatRepeatedItsLevelAndIsSilentNow) {
  auto relay = must(TouchRelay::open(
      participant, "/touch", must(DdsTriggerSender::open(participant, "trigger", wakeup)), wakeup));
  auto levels =
      must(DdsReader<dds::StampedBool>::open(participant, ros_topic("trigger"), kExchange));
  auto touch = must(DdsWriter<dds::Bool>::open(participant, ros_topic("touch"), {}, &wakeup));
  ASSERT_TRUE(eventually(
      [&] { return levels.matched() == 1 && relay->publishers() == 1 && touch.matched() == 1; }));
  Nanoseconds now = 100 * kSecond;
  int heard = 0;
  const auto turn = [&] {
    now += kSecond / 10;
    must(relay->turn(now));
    must(levels.take([&](const dds::StampedBool&) { ++heard; }));
  };
  const dds::Bool open{false};
  for (int i = 0; i < 10; ++i) {
    must(touch.write(open));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    turn();
  }
  EXPECT_TRUE(eventually([&] {
    turn();
    return heard >= 5;
  }));
  now += kSecond;
  for (int i = 0; i < 3; ++i) turn();
  heard = 0;
  for (int i = 0; i < 10; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    turn();
  }
  EXPECT_EQ(relay->publishers(), 1);
  EXPECT_EQ(heard, 0);
}

}  // namespace
}  // namespace selfcal
