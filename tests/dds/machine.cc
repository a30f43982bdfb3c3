// Trigger, motion and thermometer against a robot's side in the same process.

#include <gmock/gmock.h>

#include <cmath>

#include "io/dds/encoders.h"
#include "io/dds/motion.h"
#include "io/dds/names.h"
#include "io/dds/robot_side.h"
#include "io/dds/thermometer.h"
#include "io/dds/trigger.h"
#include "tests/dds/domain.h"

namespace selfcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class DdsMachine : public DdsTest {
 protected:
  void SetUp() override {
    robot = must(DdsRobotSide::open(participant, {.robot = "r", .joints = {"a"}}, wakeup));
    ASSERT_TRUE(eventually([&] {
      return robot->connected() && robot->heard() && motion->connected() &&
             encoders->publishers() == 1 && trigger->publishers() == 1;
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

TEST_F(DdsMachine, CarriesRequestsStopsAndReplies) {
  must(motion->request({.id = 41,
                        .kind = MoveKind::seat,
                        .label = "table 17",
                        .q = {0.1, -0.2, 0.3},
                        .speed = 0.5}));
  must(motion->stop("a person asked"));
  std::vector<RobotRequest> requests;
  must(robot->take(requests));
  must(robot->reply({.id = 41, .outcome = MotionReply::Outcome::accepted, .why = ""}));
  must(robot->reply({.id = 41, .outcome = MotionReply::Outcome::refused, .why = "out of reach"}));
  std::vector<MotionReply> replies;
  must(motion->take(replies));

  ASSERT_EQ(requests.size(), 2);
  EXPECT_FALSE(requests[0].stop);
  EXPECT_EQ(requests[0].move.id, 41);
  EXPECT_EQ(requests[0].move.kind, MoveKind::seat);
  EXPECT_EQ(requests[0].move.label, "table 17");
  EXPECT_THAT(requests[0].move.q, ElementsAre(0.1, -0.2, 0.3));
  EXPECT_EQ(requests[0].move.speed, 0.5);
  EXPECT_TRUE(requests[1].stop);
  EXPECT_EQ(requests[1].why, "a person asked");
  EXPECT_EQ(requests[1].move.id, 41);
  ASSERT_EQ(replies.size(), 2);
  EXPECT_EQ(replies[0].id, 41);
  EXPECT_EQ(replies[0].outcome, MotionReply::Outcome::accepted);
  EXPECT_EQ(replies[1].outcome, MotionReply::Outcome::refused);
  EXPECT_EQ(replies[1].why, "out of reach");
}

TEST_F(DdsMachine, CarriesEveryKindAndOutcome) {
  for (const auto kind : {MoveKind::travel, MoveKind::touch, MoveKind::seat, MoveKind::retract})
    must(motion->request({.id = 1, .kind = kind, .label = "", .q = {}, .speed = 1}));
  for (const auto outcome : {MotionReply::Outcome::accepted, MotionReply::Outcome::done,
                             MotionReply::Outcome::stopped, MotionReply::Outcome::refused})
    must(robot->reply({.id = 1, .outcome = outcome, .why = ""}));
  std::vector<RobotRequest> requests;
  std::vector<MotionReply> replies;
  must(robot->take(requests));
  must(motion->take(replies));

  ASSERT_EQ(requests.size(), 4);
  ASSERT_EQ(replies.size(), 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(static_cast<int>(requests[i].move.kind), i);
    EXPECT_EQ(static_cast<int>(replies[i].outcome), i);
  }
}

TEST_F(DdsMachine, RefusesAKindOfMotionThatIsNone) {
  auto writer = must(DdsWriter<dds::MotionRequest>::open(
      participant, robot_topic("r", "motion_request"), kExchange, &wakeup));
  ASSERT_TRUE(eventually([&] { return writer.matched() == 1; }));
  char kind[] = "leap", empty[] = "";
  must(writer.write(
      {.id_ = 5, .kind_ = kind, .label_ = empty, .q_ = {}, .speed_ = 1, .why_ = empty}));
  std::vector<RobotRequest> requests;
  std::vector<MotionReply> replies;

  must(robot->take(requests));
  must(motion->take(replies));

  EXPECT_TRUE(requests.empty());
  ASSERT_EQ(replies.size(), 1);
  EXPECT_EQ(replies[0].id, 5);
  EXPECT_EQ(replies[0].outcome, MotionReply::Outcome::refused);
  EXPECT_THAT(replies[0].why, HasSubstr("\"leap\" is no kind of motion"));
}

TEST_F(DdsMachine, TakesAnOutcomeThatIsNoneForARefusal) {
  auto writer = must(DdsWriter<dds::MotionReply>::open(
      participant, robot_topic("r", "motion_reply"), kExchange, &wakeup));
  ASSERT_TRUE(eventually([&] { return writer.matched() == 1; }));
  char outcome[] = "perhaps", why[] = "";
  must(writer.write({.id_ = 6, .outcome_ = outcome, .why_ = why}));
  std::vector<MotionReply> replies;

  must(motion->take(replies));

  ASSERT_EQ(replies.size(), 1);
  EXPECT_EQ(replies[0].outcome, MotionReply::Outcome::refused);
  EXPECT_THAT(replies[0].why, HasSubstr("perhaps"));
}

TEST_F(DdsMachine, FailsARequestThatNobodyHears) {
  robot.reset();
  ASSERT_TRUE(eventually([&] { return !motion->connected(); }));

  const auto asked = motion->request({.id = 1, .label = "", .q = {}});

  ASSERT_FALSE(asked);
  EXPECT_THAT(asked.error().what, HasSubstr("no robot listens on rt/selfcal/r/motion_request"));
  EXPECT_TRUE(motion->stop("whatever"));
}

TEST_F(DdsMachine, FailsInTimeWhenARobotTakesNoRequests) {
  const MotionRequest request{.id = 1, .label = "", .q = {}};
  Result<void> asked;
  int count = 0;
  while (asked && count <= 2 * kMostKept) {
    asked = motion->request(request);
    ++count;
  }
  const Nanoseconds start = monotonic_now();
  const auto stopped = motion->stop("now");

  EXPECT_FALSE(asked);
  EXPECT_GE(count, kMostKept);
  EXPECT_FALSE(stopped);
  EXPECT_LT(monotonic_now() - start, 10 * kLongestBlocking);
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
