// Encoders and a robot on a real bus.
#include <gmock/gmock.h>
#include <time.h>

#include <chrono>
#include <map>
#include <thread>

#include "io/clock.h"
#include "tests/can/interface.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

class CanEncodersOnABus : public CanInterfaceTest {
 protected:
  /// Between which moments the robot took the positions of cycle k.
  struct Taken {
    Nanoseconds from = 0, to = 0;
    std::optional<Nanoseconds> stamp;
  };

  void open(const CanSettings& settings) {
    encoders = must(CanEncoders::open(settings));
    open_robot(settings);
  }
  void open_robot(CanSettings settings) {
    if (settings.interface == interface_) settings.interface = robot_interface_;
    robot = must(CanRobotSide::open(settings));
  }
  /// A cycle: joints stand at k and -k.
  void publish(int k) {
    Taken t;
    t.from = monotonic_now();
    t.stamp = must(robot->sync(kSecond));
    t.to = monotonic_now();
    must(robot->publish_counts({k, -k}));
    taken[k] = t;
    take();
    std::this_thread::sleep_for(cycle);
  }
  void take() { must(encoders->take(samples)); }
  /// Publishes until the last sample is of cycle `k` or later.
  bool publish_until(int k) {
    return eventually([&] {
      publish(++last);
      return !samples.empty() && samples.back().counts[0] >= k;
    });
  }
  void publish_to(int k) {
    while (last < k) publish(++last);
  }
  std::uint64_t tally(CanFault fault) {
    return encoders->tallies()[static_cast<std::size_t>(fault)].count;
  }
  /// An emulated processor reads its clocks within some 10 us, and of two emulated controllers on
  /// one bus each tells of a frame when its turn comes.
  Nanoseconds slack() const { return robot_interface_ == interface_ ? 50'000 : 20 * kMillisecond; }
  /// Every sample is of one cycle and of its time.
  void expect_paired() {
    for (const EncoderSample& sample : samples) {
      const auto k = static_cast<int>(sample.counts[0]);
      ASSERT_EQ(sample.counts[1], -k);
      ASSERT_TRUE(taken.contains(k));
      ASSERT_GE(sample.time, taken[k].from - slack()) << "cycle " << k;
      ASSERT_LE(sample.time, taken[k].to + slack()) << "cycle " << k;
    }
  }

  std::unique_ptr<CanEncoders> encoders;
  std::unique_ptr<CanRobotSide> robot;
  std::vector<EncoderSample> samples;
  std::map<int, Taken> taken;
  int last = 0;
  std::chrono::milliseconds cycle{2};  ///< the robot's
};

TEST_F(CanEncodersOnABus, GiveEveryCycleAtItsSync) {
  cycle = std::chrono::milliseconds(10);
  open(settings());
  ASSERT_TRUE(publish_until(10));
  const auto first = samples.back().counts[0];
  ASSERT_TRUE(publish_until(last + 100));
  // A processor that does other things for most of a cycle makes the robot's answer come too late.
  EXPECT_GE(samples.back().counts[0], first + 95);
  EXPECT_LE(encoders->incomplete(), 5u);
  expect_paired();
  for (const EncoderSample& sample : samples) {
    const auto& stamp = taken[static_cast<int>(sample.counts[0])].stamp;
    EXPECT_NEAR(static_cast<double>(sample.time - stamp.value_or(sample.time)), 0,
                static_cast<double>(slack()));
  }
  EXPECT_EQ(encoders->dropped(), 0u);
  EXPECT_EQ(encoders->senders(), 1);
  EXPECT_EQ(encoders->trouble(), "");
}

TEST_F(CanEncodersOnABus, WriteNothing) {
  if (!is_virtual()) GTEST_SKIP() << interface_ << " counts only what this side sends";
  const std::uint64_t before = sent();
  open(settings());
  publish_to(50);
  ASSERT_TRUE(publish_until(50));
  EXPECT_EQ(sent() - before, 3u * static_cast<std::uint64_t>(last));  // SYNC and two joints
}

TEST_F(CanEncodersOnABus, SendSyncWhereTold) {
  CanSettings told = settings();
  told.sync_send_period = 0.05;
  open(told);
  ASSERT_TRUE(publish_until(20));
  expect_paired();
  EXPECT_EQ(encoders->trouble(), "");
}

TEST_F(CanEncodersOnABus, InterpolateJointsThatRunFreely) {
  CanSettings free = settings();
  free.map.sync.reset();
  ASSERT_EQ(free.map.finish(), std::nullopt);
  free.timing = {.cycle = 0.05, .window = 0.5, .delay = 0};
  encoders = must(CanEncoders::open(free));
  open_robot(free);
  EXPECT_TRUE(eventually([&] {
    ++last;
    must(robot->publish_counts({100 * last, -100 * last}));
    take();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the robot's cycle
    return samples.size() >= 20;
  }));
  // j2 comes within a fraction of the cycle after j1, in which it moves less than 100 counts.
  for (const EncoderSample& sample : samples)
    EXPECT_NEAR(static_cast<double>(sample.counts[0] + sample.counts[1]), 0, 50);
}

TEST_F(CanEncodersOnABus, ReadFdFramesToo) {
  CanSettings fd = settings();
  for (CanJoint& joint : fd.map.joints) {
    joint.fd = true;
    joint.field = byte_field(17, 8, true, true);
  }
  ASSERT_EQ(fd.map.finish(), std::nullopt);
  if (mtu() < 72) GTEST_SKIP() << interface_ << " carries no FD frames";
  open(fd);
  ASSERT_TRUE(publish_until(20));
  expect_paired();
}

TEST_F(CanEncodersOnABus, WaitForAnInterfaceThatGoesDown) {
  open(settings());
  ASSERT_TRUE(publish_until(10));
  if (!set_up(false)) GTEST_SKIP() << "may not take " << interface_ << " down";
  EXPECT_TRUE(eventually(
      [&] { return encoders->trouble().find("the interface is down") != std::string::npos; }));
  ASSERT_TRUE(set_up(true));
  EXPECT_TRUE(eventually(
      [&] { return encoders->trouble().find("the interface is down") == std::string::npos; }));
  open_robot(settings());
  ASSERT_TRUE(publish_until(last + 10));
  expect_paired();
  EXPECT_EQ(tally(CanFault::interface_down), 1u);
}

TEST_F(CanEncodersOnABus, SayAtTheBeginningThatTheInterfaceIsDown) {
  if (!set_up(false)) GTEST_SKIP() << "may not take " << interface_ << " down";
  encoders = must(CanEncoders::open(settings()));
  EXPECT_TRUE(eventually(
      [&] { return encoders->trouble().find("the interface is down") != std::string::npos; }));
  ASSERT_TRUE(set_up(true));
  open_robot(settings());
  ASSERT_TRUE(publish_until(10));
}

TEST_F(CanEncodersOnABus, FindAnInterfaceAgainThatWasTakenAway) {
  const auto run = [](const std::string& command) { return std::system(command.c_str()) == 0; };
  const std::string make = "ip link add scal9 type vcan && ip link set scal9 up";
  if (!run(make + " 2>/dev/null")) GTEST_SKIP() << "may not make an interface";
  CanSettings there = settings();
  there.interface = "scal9";
  open(there);
  EXPECT_TRUE(publish_until(10));
  EXPECT_TRUE(run("ip link del scal9"));
  EXPECT_TRUE(
      eventually([&] { return encoders->trouble().find("(it is gone)") != std::string::npos; }));
  EXPECT_TRUE(run(make));
  open_robot(there);
  EXPECT_TRUE(publish_until(last + 10));
  EXPECT_THAT(encoders->trouble(), Not(HasSubstr("interface")));
  expect_paired();
  run("ip link del scal9");
}

TEST_F(CanEncodersOnABus, SayThatTheControllerIsOffTheBus) {
  if (!is_virtual()) GTEST_SKIP() << interface_ << " makes its reports itself";
  open(settings());
  auto sender = must(CanSender::open(robot_interface_, false));
  CanFrame report;
  report.error = true;
  report.size = 8;
  report.id.value = 0x40;  // CAN_ERR_BUSOFF
  must(sender.send(report));
  EXPECT_TRUE(
      eventually([&] { return encoders->trouble().find("off the bus") != std::string::npos; }));
  report.id.value = 0x100;  // CAN_ERR_RESTARTED
  must(sender.send(report));
  EXPECT_TRUE(
      eventually([&] { return encoders->trouble().find("restarted") != std::string::npos; }));
  EXPECT_TRUE(eventually([&] { return encoders->trouble().empty(); }));
}

TEST_F(CanEncodersOnABus, KnowASecondSender) {
  open(settings());
  ASSERT_TRUE(publish_until(10));
  auto other = must(CanSender::open(robot_interface_, false));
  CanFrame frame;
  frame.id.value = 0x182;
  frame.size = 4;
  EXPECT_TRUE(eventually([&] {
    publish(++last);
    frame.data[1] = static_cast<std::uint8_t>(last);
    must(other.send(frame));
    return encoders->senders() == 2;
  }));
  EXPECT_THAT(encoders->trouble(), HasSubstr("a second sender (j2 (0x182))"));
  EXPECT_TRUE(eventually([&] {
    publish(++last);
    return encoders->senders() == 1;
  }));
}

TEST_F(CanEncodersOnABus, DropTheOldestSamplesThatNobodyTakes) {
  open(settings());
  EXPECT_TRUE(eventually([&] {
    for (int k = 0; k < 100; ++k) {
      must(robot->sync(kSecond));
      must(robot->publish_counts({k, -k}));
    }
    return encoders->dropped() > 0;
  }));
  take();
  EXPECT_LE(samples.size(), EncoderSource::kMostSamples);
}

TEST_F(CanEncodersOnABus, PairNothingAcrossAStepOfTheWallClock) {
  // It is the clock of the whole machine.
  if (!std::getenv("SELFCAL_MAY_STEP_CLOCK")) GTEST_SKIP() << "SELFCAL_MAY_STEP_CLOCK is not set";
  const auto step = [](Nanoseconds by) {
    const Nanoseconds to = realtime_now() + by;
    const timespec time{.tv_sec = to / kSecond, .tv_nsec = to % kSecond};
    return clock_settime(CLOCK_REALTIME, &time) == 0;
  };
  open(settings());
  publish_to(50);
  const Nanoseconds hour = 3600 * kSecond;
  for (const Nanoseconds by : {hour, -hour, hour, -hour, kSecond, -kSecond}) {
    if (!step(by)) GTEST_SKIP() << "may not step the clock";
    publish_to(last + 100);
  }
  ASSERT_TRUE(publish_until(last + 1));
  expect_paired();
  EXPECT_EQ(tally(CanFault::time_stepped), 6u);
  EXPECT_GT(samples.size(), 400u);
  EXPECT_GT(encoders->dropped(), 0u);
  EXPECT_THAT(encoders->trouble(), HasSubstr("the wall clock stepped"));
  EXPECT_TRUE(eventually([&] {
    publish(++last);
    // Cycles as fast as these may come late all the time.
    return encoders->trouble().find("stepped") == std::string::npos;
  })) << "told while it is recent: "
      << encoders->trouble();
}

}  // namespace
}  // namespace selfcal
