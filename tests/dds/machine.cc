// Trigger and thermometer against a robot's side in the same process.

#include <gtest/gtest.h>

#include <cmath>

#include "io/dds/encoders.h"
#include "io/dds/motion.h"
#include "io/dds/robot_side.h"
#include "io/dds/senders.h"
#include "io/dds/thermometer.h"
#include "io/dds/trigger.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class DdsMachine : public DdsTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(eventually([&] {
      return robot->connected() && joints->matched() == 1 && contact->matched() == 1 &&
             motion->connected() && encoders->senders() == 1 && trigger->senders() == 1;
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
  std::unique_ptr<DdsRobotSide> robot =
      must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
  std::unique_ptr<DdsJointSender> joints =
      must(DdsJointSender::open(participant, "joint_states", {"a"}, wakeup));
  std::unique_ptr<DdsTriggerSender> contact =
      must(DdsTriggerSender::open(participant, "touch_trigger", wakeup));
};

TEST_F(DdsMachine, TellsTheTriggersLevelBeforeAnyEdge) {
  EXPECT_FALSE(trigger->closed());

  must(contact->send(1000, true));

  EXPECT_EQ(trigger->closed(), true);
  EXPECT_TRUE(edges().empty());
}

TEST_F(DdsMachine, MakesAnEdgeOfEachChangeAndNoneOfARepetition) {
  const Nanoseconds start = 1'790'000'000 * kSecond;
  std::vector<EncoderSample> samples;
  must(contact->send(start, false));
  must(joints->send(start + 10, {0}));
  must(contact->send(start + 17, true));
  must(contact->send(start + 17, true));
  must(contact->send(start + 23, false));
  must(joints->send(start + 30, {0}));

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
  must(contact->send(0, false));
  must(contact->send(7, true));
  EXPECT_TRUE(edges().empty());
  std::vector<EncoderSample> samples;

  must(joints->send(10, {0}));
  must(encoders->take(samples));
  const auto taken = edges();

  ASSERT_EQ(taken.size(), 1);
  EXPECT_EQ(samples.at(0).time - taken[0].time, 3);
}

TEST_F(DdsMachine, BoundsTheEdgesThatWait) {
  for (int i = 0; i < 400; ++i) {
    must(contact->send(i, i % 2 == 1));
    trigger->closed();
  }
  std::vector<EncoderSample> samples;
  must(joints->send(1000, {0}));
  must(encoders->take(samples));

  EXPECT_EQ(edges().size(), TouchTrigger::kMostEdges);
  EXPECT_EQ(trigger->dropped(), 399 - TouchTrigger::kMostEdges);
}

/// A trigger that misses what has been repeated soon.
class DdsTriggerSilence : public DdsMachine {
 protected:
  static constexpr Nanoseconds kSilence = 50 * kMillisecond;
  DdsTriggerSilence() {
    trigger = must(DdsTrigger::open(participant, {.silence = kSilence}, mapping, wakeup));
  }
  /// For much longer than that.
  void meanwhile(const std::function<void()>& act) {
    const Nanoseconds end = monotonic_now() + 10 * kSilence;
    EXPECT_TRUE(eventually([&] {
      act();
      (void)trigger->closed();
      return monotonic_now() > end;
    }));
  }
};

TEST_F(DdsTriggerSilence, MakesTheLevelOfWhoHasRepeatedItUnknown) {
  meanwhile([&] { must(contact->send(1000, false)); });
  EXPECT_EQ(trigger->closed(), false);
  EXPECT_EQ(trigger->trouble(), "");

  ASSERT_TRUE(eventually([&] { return !trigger->closed(); }));
  EXPECT_EQ(trigger->trouble(), "its level, repeated before, has not come for 0.05 s");

  must(contact->send(2000, true));
  EXPECT_EQ(trigger->closed(), true);
  EXPECT_EQ(trigger->trouble(), "");
}

TEST_F(DdsTriggerSilence, SaysNothingOfWhoTellsOfChangesAlone) {
  must(contact->send(1000, false));
  meanwhile([] {});
  EXPECT_EQ(trigger->closed(), false);
  must(contact->send(2000, true));
  meanwhile([] {});
  EXPECT_EQ(trigger->closed(), true);
}

TEST_F(DdsMachine, ForgetsTheLevelOfAPublisherThatIsGone) {
  must(contact->send(1000, true));
  EXPECT_EQ(trigger->closed(), true);

  contact.reset();

  EXPECT_TRUE(eventually([&] { return !trigger->closed(); }));
}

TEST_F(DdsMachine, WakesTheServiceForTheTriggerAndRepliesButNotForJointStates) {
  while (wakeup.wait(0)) {
  }

  must(joints->send(0, {0}));
  EXPECT_FALSE(wakeup.wait(0));
  must(contact->send(0, true));
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
