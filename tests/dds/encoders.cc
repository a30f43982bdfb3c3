// Joint states as encoder samples.

#include "io/dds/encoders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/dds/names.h"
#include "io/dds/senders.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class DdsEncodersTest : public DdsTest {
 protected:
  // A robot that names its joints so, heard by the encoders.
  void connect(const std::vector<std::string>& names) {
    robot = must(DdsJointSender::open(participant, "joint_states", names, wakeup));
    ASSERT_TRUE(eventually([&] { return encoders->senders() == 1; }));
  }
  // Another takes its place, that names them so.
  void replace_robot(const std::vector<std::string>& names) {
    robot.reset();
    ASSERT_TRUE(eventually([&] { return encoders->senders() == 0; }));
    connect(names);
  }
  std::vector<EncoderSample> take() {
    std::vector<EncoderSample> samples;
    must(encoders->take(samples));
    return samples;
  }

  std::shared_ptr<TimeMapping> mapping = std::make_shared<TimeMapping>();
  std::unique_ptr<DdsEncoders> encoders =
      must(DdsEncoders::open(participant, {.joints = {"a", "b", "c"}}, mapping));
  std::unique_ptr<DdsJointSender> robot;
};

TEST_F(DdsEncodersTest, TakeJointsInTheirOwnOrder) {
  connect({"gripper", "c", "a", "b"});

  must(robot->send(1000, {9, 0.3, -0.1, 0.2}));
  const auto samples = take();

  ASSERT_EQ(samples.size(), 1);
  EXPECT_EQ(samples[0].joints, 3);
  EXPECT_EQ(samples[0].counts[0], -100'000'000);
  EXPECT_EQ(samples[0].counts[1], 200'000'000);
  EXPECT_EQ(samples[0].counts[2], 300'000'000);
  EXPECT_EQ(encoders->scales().size(), 3);
  EXPECT_EQ(encoders->scales()[1].step, 1e-9);
  EXPECT_EQ(encoders->scales()[1].zero, 0);
}

TEST_F(DdsEncodersTest, FollowAnOrderThatChanges) {
  connect({"a", "b", "c"});
  must(robot->send(1000, {1, 2, 3}));
  const auto first = take();
  replace_robot({"c", "b", "a"});
  must(robot->send(2000, {3, 2, 1}));
  const auto second = take();

  ASSERT_EQ(first.size(), 1);
  ASSERT_EQ(second.size(), 1);
  EXPECT_EQ(first[0].counts, second[0].counts);
}

TEST_F(DdsEncodersTest, BelieveTheFirstWriterAlone) {
  connect({"a", "b", "c"});
  must(robot->send(1000, {1, 2, 3}));
  ASSERT_EQ(take().size(), 1);
  auto stranger = must(DdsJointSender::open(participant, "joint_states", {"a", "b", "c"}, wakeup));
  ASSERT_TRUE(eventually([&] { return encoders->senders() == 2; }));

  must(stranger->send(1500, {9, 9, 9}));
  must(robot->send(2000, {3, 2, 1}));
  const auto samples = take();

  ASSERT_EQ(samples.size(), 1);
  EXPECT_EQ(samples[0].counts[0], 3'000'000'000);
  EXPECT_EQ(encoders->strange(), 1);
}

TEST_F(DdsEncodersTest, BelieveNobodyWhileSeveralWereThereFromTheStart) {
  connect({"a", "b", "c"});
  auto stranger = must(DdsJointSender::open(participant, "joint_states", {"a", "b", "c"}, wakeup));
  ASSERT_TRUE(eventually([&] { return encoders->senders() == 2; }));
  must(stranger->send(1500, {9, 9, 9}));
  must(robot->send(2000, {3, 2, 1}));
  EXPECT_TRUE(take().empty());

  stranger.reset();
  ASSERT_TRUE(eventually([&] { return encoders->senders() == 1; }));
  must(robot->send(3000, {3, 2, 1}));
  EXPECT_EQ(take().size(), 1);
}

TEST_F(DdsEncodersTest, MakeNoSampleOfAMessageThatLacksAJoint) {
  connect({"a", "b"});

  must(robot->send(1000, {1, 2}));

  EXPECT_TRUE(take().empty());
  EXPECT_EQ(encoders->tallies().at(0).name, "incomplete");
  EXPECT_EQ(encoders->tallies().at(0).count, 1);
  EXPECT_EQ(encoders->dropped(), 0);
}

TEST_F(DdsEncodersTest, SayWhatTheLastMessagesLackUntilASampleComes) {
  connect({"a", "b", "x"});

  must(robot->send(1000, {1, 2, 3}));
  take();
  EXPECT_EQ(encoders->trouble(), "the last message lacks joint c");
  must(robot->send(2000, {1, 2, 3}));
  take();
  EXPECT_EQ(encoders->trouble(), "the last messages lack joint c");
  replace_robot({"a", "b", "c"});
  must(robot->send(3000, {1, 2}));
  take();
  EXPECT_EQ(encoders->trouble(), "the last messages have no position of joint c");
  must(robot->send(4000, {1, 2, 3}));
  take();
  EXPECT_EQ(encoders->trouble(), "");
}

TEST_F(DdsEncodersTest, MakeNoSampleOfAMessageWithoutAPositionOrWithOneThatIsNone) {
  connect({"a", "b", "c"});

  must(robot->send(1000, {1, 2}));
  must(robot->send(2000, {}));
  must(robot->send(3000, {1, std::nan(""), 3}));
  must(robot->send(4000, {1, std::numeric_limits<double>::infinity(), 3}));
  must(robot->send(5000, {1, 1e300, 3}));

  EXPECT_TRUE(take().empty());
  EXPECT_EQ(encoders->tallies().at(0).count, 5);
}

TEST_F(DdsEncodersTest, StampTheFirstWithItsArrivalAndKeepDifferences) {
  connect({"a", "b", "c"});
  const Nanoseconds before = monotonic_now();
  must(robot->send(1000, {1, 2, 3}));
  const Nanoseconds after = monotonic_now();
  const auto first = take();

  must(robot->send(1'234'567, {1, 2, 3}));
  const auto second = take();

  ASSERT_EQ(first.size(), 1);
  ASSERT_EQ(second.size(), 1);
  EXPECT_GE(first[0].time, before);
  EXPECT_LE(first[0].time, after);
  EXPECT_EQ(second[0].time - first[0].time, 1'233'567);
}

TEST_F(DdsEncodersTest, DropWhatIsBeforeAStepOfTheSendersClock) {
  connect({"a", "b", "c"});
  must(robot->send(0, {1, 2, 3}));
  take();

  must(robot->send(1000, {1, 2, 3}));
  must(robot->send(100 * kSecond, {4, 5, 6}));
  const auto samples = take();

  ASSERT_EQ(samples.size(), 1);
  EXPECT_EQ(samples[0].counts[0], 4'000'000'000);
  EXPECT_LE(samples[0].time, monotonic_now());
  EXPECT_EQ(encoders->dropped(), 1);
  EXPECT_EQ(mapping->steps(), 1);
}

TEST_F(DdsEncodersTest, LoseNothingOfTenThousandWhenTakenInTime) {
  connect({"a", "b", "c"});
  std::vector<EncoderSample> samples;
  const Nanoseconds start = realtime_now();
  for (int i = 0; i < 10'000; ++i) {
    must(robot->send(start + i * 1000, {i * 1e-9, 0, 0}));
    if (i % 10 == 9) must(encoders->take(samples));
  }

  ASSERT_EQ(samples.size(), 10'000);
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_EQ(samples[i].counts[0], i);
    ASSERT_EQ(samples[i].time - samples[0].time, i * 1000);
  }
  EXPECT_EQ(encoders->dropped(), 0);
  EXPECT_EQ(encoders->tallies().at(0).count, 0);
}

TEST_F(DdsEncodersTest, DropTheOldestAndCountThemWhenNotTakenInTime) {
  connect({"a", "b", "c"});
  const Nanoseconds start = realtime_now();
  for (int i = 0; i < 10'000; ++i) must(robot->send(start + i, {i * 1e-9, 0, 0}));

  const auto samples = take();
  take();

  ASSERT_EQ(samples.size(), 1024);
  EXPECT_EQ(samples.front().counts[0], 10'000 - 1024);
  EXPECT_EQ(samples.back().counts[0], 9'999);
  EXPECT_EQ(encoders->dropped(), 10'000 - 1024);
}

TEST_F(DdsEncodersTest, CountNothingWhenAPublisherComesAndGoes) {
  for (int i = 0; i < 3; ++i) {
    connect({"a", "b", "c"});
    must(robot->send(1000, {1, 2, 3}));
    EXPECT_EQ(take().size(), 1);
    robot.reset();
    EXPECT_TRUE(eventually([&] { return encoders->senders() == 0; }));
    EXPECT_TRUE(take().empty());
  }

  EXPECT_EQ(encoders->dropped(), 0);
}

TEST_F(DdsEncodersTest, AreHeardFromBestEffortPublishersToo) {
  auto writer = must(DdsWriter<dds::JointState>::open(participant, ros_topic("joint_states"),
                                                      {.reliable = false, .depth = 5}));

  EXPECT_TRUE(eventually([&] { return encoders->senders() == 1 && writer.matched() == 1; }));
}

TEST_F(DdsEncodersTest, RefuseNoJointsAndTooMany) {
  EXPECT_FALSE(DdsEncoders::open(participant, {.joints = {}}, mapping));
  EXPECT_FALSE(DdsEncoders::open(
      participant, {.joints = std::vector<std::string>(kMostJoints + 1, "a")}, mapping));
}

}  // namespace
}  // namespace selfcal
