// Trigger and thermometer against a robot's side in the same process.

#include <gtest/gtest.h>

#include <cmath>

#include "io/dds/encoders.h"
#include "io/dds/motion.h"
#include "io/dds/robot_side.h"
#include "io/dds/thermometer.h"
#include "io/dds/trigger.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class DdsMachine : public DdsTest {
 protected:
  void SetUp() override {
    robot = must(DdsRobotSide::open(participant, {.robot = "r", .joints = {"a"}}, wakeup));
    ASSERT_TRUE(eventually([&] {
      return robot->connected() && robot->heard() && motion->connected() &&
             encoders->senders() == 1 && trigger->publishers() == 1;
    }));
  }
  std::vector<Edge> edges() {
    std::vector<Edge> taken;
    must(trigger->take(taken));
    return taken;
  }

  std::shared_ptr<TimeMapping> mapping = std::make_shared<TimeMapping>();
  std::unique_ptr<DdsEncoders> encoders =
      must(DdsEncoders::open(participant, {.joints = {"a"}}, mapping));
  std::unique_ptr<DdsTrigger> trigger = must(DdsTrigger::open(participant, {}, mapping, wakeup));
  std::unique_ptr<DdsMotion> motion = must(DdsMotion::open(participant, "r", wakeup));
  std::unique_ptr<DdsRobotSide> robot;
};

TEST_F(DdsMachine, TellsTheTriggersLevelBeforeAnyEdge) {
  EXPECT_FALSE(trigger->closed());

  must(robot->publish_trigger(1000, true));

  EXPECT_EQ(trigger->closed(), true);
  EXPECT_TRUE(edges().empty());
}

TEST_F(DdsMachine, MakesAnEdgeOfEachChangeAndNoneOfARepetition) {
  const Nanoseconds start = 1'790'000'000 * kSecond;
  std::vector<EncoderSample> samples;
  must(robot->publish_trigger(start, false));
  must(robot->publish_joints(start + 10, {0}));
  must(robot->publish_trigger(start + 17, true));
  must(robot->publish_trigger(start + 17, true));
  must(robot->publish_trigger(start + 23, false));
  must(robot->publish_joints(start + 30, {0}));

  must(encoders->take(samples));
  const auto taken = edges();

  ASSERT_EQ(samples.size(), 2);
  ASSERT_EQ(taken.size(), 2);
  EXPECT_TRUE(taken[0].closed);
  EXPECT_FALSE(taken[1].closed);
  EXPECT_EQ(taken[0].time - samples[0].time, 7);  // exactly, whatever the way took
  EXPECT_EQ(samples[1].time - taken[1].time, 7);
  EXPECT_EQ(trigger->closed(), false);
  EXPECT_TRUE(edges().empty());
}

TEST_F(DdsMachine, KeepsEdgesUntilTheirTimeIsKnown) {
  must(robot->publish_trigger(0, false));
  must(robot->publish_trigger(7, true));
  EXPECT_TRUE(edges().empty());
  std::vector<EncoderSample> samples;

  must(robot->publish_joints(10, {0}));
  must(encoders->take(samples));
  const auto taken = edges();

  ASSERT_EQ(taken.size(), 1);
  EXPECT_EQ(samples.at(0).time - taken[0].time, 3);
}

TEST_F(DdsMachine, BoundsTheEdgesThatWait) {
  for (int i = 0; i < 400; ++i) {
    must(robot->publish_trigger(i, i % 2 == 1));
    trigger->closed();
  }
  std::vector<EncoderSample> samples;
  must(robot->publish_joints(1000, {0}));
  must(encoders->take(samples));

  EXPECT_EQ(edges().size(), TouchTrigger::kMostEdges);
  EXPECT_EQ(trigger->dropped(), 399 - TouchTrigger::kMostEdges);
}

TEST_F(DdsMachine, ForgetsTheLevelOfAPublisherThatIsGone) {
  must(robot->publish_trigger(1000, true));
  EXPECT_EQ(trigger->closed(), true);

  robot.reset();

  EXPECT_TRUE(eventually([&] { return !trigger->closed(); }));
}

TEST_F(DdsMachine, WakesTheServiceForTheTriggerAndRepliesButNotForJointStates) {
  while (wakeup.wait(0)) {
  }

  must(robot->publish_joints(0, {0}));
  EXPECT_FALSE(wakeup.wait(0));
  must(robot->publish_trigger(0, true));
  EXPECT_TRUE(wakeup.wait(kLimit));
  must(robot->reply(MotionReply()));
  EXPECT_TRUE(wakeup.wait(kLimit));
}

TEST_F(DdsMachine, KnowsTheTemperatureForAsLongAsItIsFresh) {
  const auto thermometer = must(DdsThermometer::open(participant, {.oldest = 200 * kMillisecond}));
  EXPECT_FALSE(thermometer->celsius());
  ASSERT_TRUE(eventually([&] {
    must(robot->publish_temperature(5, 21.5));
    return thermometer->celsius() == 21.5;
  }));

  EXPECT_TRUE(eventually([&] { return !thermometer->celsius(); }));
}

TEST_F(DdsMachine, DoesNotKnowATemperatureThatIsNoNumber) {
  const auto thermometer = must(DdsThermometer::open(participant, {}));
  ASSERT_TRUE(eventually([&] {
    must(robot->publish_temperature(5, 21.5));
    return thermometer->celsius() == 21.5;
  }));

  must(robot->publish_temperature(6, std::nan("")));

  EXPECT_FALSE(thermometer->celsius());
}

}  // namespace
}  // namespace selfcal
