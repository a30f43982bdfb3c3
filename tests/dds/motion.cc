// Requests for motion and their replies, in one process.

#include "io/dds/motion.h"

#include <gmock/gmock.h>

#include "io/dds/names.h"
#include "io/dds/robot_side.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class DdsMotionTest : public DdsTest {
 protected:
  void SetUp() override {
    robot = must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
    ASSERT_TRUE(eventually([&] { return robot->connected() && motion->connected(); }));
  }

  std::unique_ptr<DdsMotion> motion = must(DdsMotion::open(participant, "r", wakeup));
  std::unique_ptr<DdsRobotSide> robot;
};

TEST_F(DdsMotionTest, CarriesRequestsStopsAndReplies) {
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

TEST_F(DdsMotionTest, CarriesEveryKindAndOutcome) {
  for (const auto kind : {MoveKind::travel, MoveKind::touch, MoveKind::seat, MoveKind::retract,
                          MoveKind::lock, MoveKind::visit, MoveKind::release})
    must(motion->request({.id = 1, .kind = kind, .label = "", .q = {}, .speed = 1}));
  for (const auto outcome : {MotionReply::Outcome::accepted, MotionReply::Outcome::done,
                             MotionReply::Outcome::stopped, MotionReply::Outcome::refused})
    must(robot->reply({.id = 1, .outcome = outcome, .why = ""}));
  std::vector<RobotRequest> requests;
  std::vector<MotionReply> replies;
  must(robot->take(requests));
  must(motion->take(replies));

  ASSERT_EQ(requests.size(), 7);
  ASSERT_EQ(replies.size(), 4);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(static_cast<int>(requests[i].move.kind), i);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(static_cast<int>(replies[i].outcome), i);
}

TEST_F(DdsMotionTest, RefusesAKindOfMotionThatIsNone) {
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

TEST_F(DdsMotionTest, TakesNoReplyOfAnybodyButTheRobot) {
  must(robot->reply({.id = 6, .outcome = MotionReply::Outcome::done, .why = ""}));
  std::vector<MotionReply> replies;
  ASSERT_TRUE(eventually([&] { return must(motion->take(replies)), replies.size() == 1; }));
  const auto stranger = must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
  ASSERT_TRUE(eventually([&] { return motion->senders() == 2; }));

  must(stranger->reply({.id = 7, .outcome = MotionReply::Outcome::done, .why = ""}));
  must(robot->reply({.id = 8, .outcome = MotionReply::Outcome::done, .why = ""}));

  ASSERT_TRUE(eventually([&] { return must(motion->take(replies)), replies.size() == 2; }));
  EXPECT_EQ(replies[1].id, 8);
  EXPECT_EQ(motion->strange(), 1);
}

TEST_F(DdsMotionTest, TakesAnOutcomeThatIsNoneForARefusal) {
  robot.reset();
  ASSERT_TRUE(eventually([&] { return motion->senders() == 0; }));
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

TEST_F(DdsMotionTest, FailsARequestThatNobodyHears) {
  robot.reset();
  ASSERT_TRUE(eventually([&] { return !motion->connected(); }));

  const auto asked = motion->request({.id = 1, .label = "", .q = {}});

  ASSERT_FALSE(asked);
  EXPECT_THAT(asked.error().what, HasSubstr("no robot listens on rt/selfcal/r/motion_request"));
  EXPECT_TRUE(motion->stop("whatever"));
}

TEST_F(DdsMotionTest, FailsInTimeWhenARobotTakesNoRequests) {
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

}  // namespace
}  // namespace selfcal
