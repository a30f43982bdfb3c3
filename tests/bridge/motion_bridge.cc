// The bridge between a service's motion port and a controller of the test's.
#include "app/bridge/motion_bridge.h"

#include <gmock/gmock.h>

#include "io/dds/encoders.h"
#include "io/dds/motion.h"
#include "io/dds/names.h"
#include "io/dds/senders.h"
#include "tests/bridge/controller.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using Outcome = MotionReply::Outcome;

constexpr const char* kAction = "/arm/follow_joint_trajectory";

class Bridged : public DdsTest {
 protected:
  Bridged() {
    joints[0].name = "a";
    joints[1].name = "b";
    joints[0].lower = joints[1].lower = -2;
    joints[0].upper = joints[1].upper = 2;
    bridge.emplace(MotionBridgeOptions{.acceleration = 1,
                                       .patience = 300 * kMillisecond,
                                       .slack = 300 * kMillisecond,
                                       .action = kAction},
                   joints, *robot, *action);
  }
  void SetUp() override {
    ASSERT_TRUE(eventually([&] { return motion->connected() && robot->connected(); }));
  }
  void start_controller() {
    controller.emplace(participant, kAction, wakeup);
    ASSERT_TRUE(eventually([&] { return action->connected(); }));
  }
  /// Turns the bridge, the joints standing at `here`, until the test has what it waits for.
  bool turning(const std::function<bool()>& holds) {
    return eventually([&] {
      if (joints_speak) bridge->see(here, monotonic_now());
      must(bridge->turn(monotonic_now()));
      if (controller) controller->hear();
      must(motion->take(replies));
      return holds();
    });
  }
  bool told(Outcome outcome) {
    return turning([&] { return !replies.empty() && replies.back().outcome == outcome; });
  }
  void ask(MoveKind kind = MoveKind::travel, std::vector<double> q = {1, 0}) {
    must(motion->request({.id = ++id, .kind = kind, .label = "", .q = std::move(q), .speed = 0.5}));
  }
  /// A move that the controller has accepted.
  void begin_move() {
    start_controller();
    ask();
    ASSERT_TRUE(turning([&] { return controller->goals.size() == 1; }));
    controller->accept(controller->goals[0]);
    ASSERT_TRUE(turning([&] { return controller->asked.size() == 1; }));
    ASSERT_TRUE(told(Outcome::accepted));
  }

  std::vector<Joint> joints{2};
  std::unique_ptr<DdsMotion> motion = must(DdsMotion::open(participant, "r", wakeup));
  std::unique_ptr<DdsRobotSide> robot =
      must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
  std::unique_ptr<TrajectoryAction> action =
      must(TrajectoryAction::open(participant, kAction, {"a", "b"}, wakeup));
  std::optional<MotionBridge> bridge;
  std::optional<FakeController> controller;
  std::vector<MotionReply> replies;
  std::vector<double> here{0.5, 0};
  bool joints_speak = true;
  std::uint64_t id = 0;
};

TEST_F(Bridged, MakesAGoalOfARequestAndAReplyOfItsResult) {
  begin_move();
  EXPECT_EQ(controller->goals[0].joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(controller->goals[0].points.back().q, (std::vector<double>{1, 0}));
  EXPECT_EQ(controller->asked[0].goal, controller->goals[0].goal);

  controller->finish(controller->asked[0], 4);

  ASSERT_TRUE(told(Outcome::done));
  EXPECT_EQ(replies.back().id, id);
}

// Less than a step that stamps are mapped anew for, and more than a position may be old.
TEST_F(Bridged, KnowsWhereTheJointsAreThoughTheirClockWasSetBack) {
  joints_speak = false;
  const auto encoders =
      must(DdsEncoders::open(participant, {.joints = {"a", "b"}}, std::make_shared<TimeMapping>()));
  const auto sender = must(DdsJointSender::open(participant, "joint_states", {"a", "b"}, wakeup));
  start_controller();
  ASSERT_TRUE(turning([&] { return sender->matched() == 1 && encoders->senders() == 1; }));
  for (const Nanoseconds set_back : {Nanoseconds{0}, 700 * kMillisecond}) {
    must(sender->send(realtime_now() - set_back, here));
    must(bridge->look(*encoders, monotonic_now()));
  }
  ask();
  EXPECT_TRUE(turning([&] { return !controller->goals.empty() || !replies.empty(); }));
  EXPECT_EQ(controller->goals.size(), 1) << (replies.empty() ? "" : replies.back().why);
}

TEST_F(Bridged, CancelsTheGoalOfAStopUntilItEnds) {
  begin_move();
  must(motion->stop("contact"));
  ASSERT_TRUE(turning([&] { return controller->cancels.size() >= 2; })) << "said again";
  EXPECT_EQ(controller->cancels[0].goal, controller->goals[0].goal);
  controller->confirm_cancel(controller->cancels[0]);
  controller->finish(controller->asked[0], 5);

  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_EQ(replies.back().why, "contact");
}

TEST_F(Bridged, CancelsTheGoalUntilItEndsBeforeItsOwnEnd) {
  begin_move();
  must(bridge->give_up(monotonic_now()));
  ask();
  ASSERT_TRUE(turning([&] { return controller->cancels.size() >= 2; })) << "said again";
  EXPECT_TRUE(bridge->moving());
  EXPECT_EQ(controller->cancels[0].goal, controller->goals[0].goal);
  controller->finish(controller->asked[0], 5);

  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_EQ(replies.back().why, "the bridge ends");
  EXPECT_FALSE(bridge->moving());
  EXPECT_EQ(controller->goals.size(), 1u) << "nothing begins any more";
  EXPECT_THAT(replies, Contains(Field(&MotionReply::outcome, Outcome::refused)));
}

TEST_F(Bridged, EndsWithinItsPatienceWhereNobodyConfirmsTheEndOfAMove) {
  begin_move();
  must(bridge->give_up(monotonic_now()));
  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_THAT(replies.back().why, HasSubstr("has not confirmed the stop"));
  EXPECT_FALSE(bridge->moving());
}

TEST_F(Bridged, CancelsAGoalThatWasAcceptedAfterTheStop) {
  start_controller();
  ask();
  ASSERT_TRUE(turning([&] { return controller->goals.size() == 1; }));
  must(motion->stop("contact"));
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  const std::size_t before = controller->cancels.size();
  controller->accept(controller->goals[0]);
  ASSERT_TRUE(
      turning([&] { return controller->cancels.size() > before && !controller->asked.empty(); }));
  controller->finish(controller->asked[0], 5);
  ASSERT_TRUE(told(Outcome::stopped));
}

TEST_F(Bridged, KeepsTheNextMoveUntilTheStoppedOneHasEnded) {
  begin_move();
  must(motion->stop("contact"));
  ask(MoveKind::retract, {0, 0});
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  EXPECT_EQ(controller->goals.size(), 1);
  controller->finish(controller->asked[0], 5);
  ASSERT_TRUE(turning([&] { return controller->goals.size() == 2; }));
  EXPECT_EQ(controller->goals[1].points.back().q, (std::vector<double>{0, 0}));
}

TEST_F(Bridged, StopsWhateverMovesWhenItHasAskedForNothing) {
  start_controller();
  must(motion->stop("fault"));
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  EXPECT_EQ(controller->cancels[0].goal, GoalId{}) << "zeros: every goal";
}

TEST_F(Bridged, RefusesByNameWhatNobodyAnswers) {
  ask();
  ASSERT_TRUE(told(Outcome::refused));
  EXPECT_EQ(replies.back().why, std::string("there is no action server ") + kAction);
  start_controller();
  ask();
  ASSERT_TRUE(turning([&] { return replies.size() == 2; }));
  EXPECT_THAT(replies.back().why, HasSubstr("does not answer"));
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); })) << "it may have begun";
  ask();
  ASSERT_TRUE(turning([&] { return controller->goals.size() == 2; }));
  controller->accept(controller->goals[1], false);
  ASSERT_TRUE(turning([&] { return replies.size() == 3; }));
  EXPECT_THAT(replies.back().why, HasSubstr("rejected the goal"));
}

TEST_F(Bridged, CancelsAGoalThatIsAcceptedAfterItWasGivenUp) {
  start_controller();
  ask();
  ASSERT_TRUE(told(Outcome::refused));
  EXPECT_THAT(replies.back().why, HasSubstr("does not answer"));
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  controller->cancels.clear();  // they came before there was anything to cancel

  controller->accept(controller->goals[0]);

  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  EXPECT_EQ(controller->cancels[0].goal, controller->goals[0].goal);
}

TEST_F(Bridged, RefusesByNameWhatTheRobotCannot) {
  start_controller();
  const auto why_of = [&](MoveKind kind, std::vector<double> q) {
    replies.clear();
    ask(kind, std::move(q));
    EXPECT_TRUE(told(Outcome::refused));
    return replies.empty() ? "" : replies.back().why;
  };
  EXPECT_THAT(why_of(MoveKind::seat, {1, 0}), HasSubstr("cannot seat"));
  EXPECT_THAT(why_of(MoveKind::travel, {1}), HasSubstr("2 joints"));
  EXPECT_THAT(why_of(MoveKind::travel, {1, 3}), HasSubstr("b cannot go to 3"));
  EXPECT_THAT(why_of(MoveKind::travel, {1, std::nan("")}), HasSubstr("b cannot go"));
  must(motion->request({.id = ++id, .label = "", .q = {1, 0}, .speed = 0}));
  replies.clear();
  ASSERT_TRUE(told(Outcome::refused));
  EXPECT_THAT(replies.back().why, HasSubstr("speed"));
  joints_speak = false;
  bridge->see(here, monotonic_now() - kSecond);
  EXPECT_THAT(why_of(MoveKind::travel, {1, 0}), HasSubstr("joint states have ceased"));
  EXPECT_TRUE(controller->goals.empty());
}

TEST_F(Bridged, TellsTheControllersError) {
  begin_move();
  controller->finish(controller->asked[0], 6, -4, "joint a is 0.3 rad behind");
  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_THAT(replies.back().why, HasSubstr("PATH_TOLERANCE_VIOLATED: joint a is 0.3 rad behind"));
}

TEST_F(Bridged, TellsAControllerThatGoesAndAMoveThatDoesNotEnd) {
  begin_move();
  controller.reset();
  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_THAT(replies.back().why, HasSubstr("is gone"));
  replies.clear();
  here = {0.99, 0};
  begin_move();
  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_THAT(replies.back().why, HasSubstr("has not ended the move in time"));
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
}

TEST_F(Bridged, StopsWhenTheJointStatesCease) {
  begin_move();
  joints_speak = false;
  ASSERT_TRUE(turning([&] { return !controller->cancels.empty(); }));
  controller->finish(controller->asked[0], 5);
  ASSERT_TRUE(told(Outcome::stopped));
  EXPECT_THAT(replies.back().why, HasSubstr("joint states have ceased"));
}

TEST_F(Bridged, StopsWhenTheServiceIsGone) {
  begin_move();
  motion.reset();
  EXPECT_TRUE(eventually([&] {
    bridge->see(here, monotonic_now());
    must(bridge->turn(monotonic_now()));
    controller->hear();
    return !controller->cancels.empty();
  }));
}

TEST_F(Bridged, BelievesNoReplyToAnother) {
  start_controller();
  ask();
  ASSERT_TRUE(turning([&] { return controller->goals.size() == 1; }));
  FakeController::Call other = controller->goals[0];
  other.client += 1;
  controller->accept(other, false);
  other = controller->goals[0];
  other.number += 1;
  controller->accept(other, false);
  controller->accept(controller->goals[0]);
  ASSERT_TRUE(told(Outcome::accepted));
}

}  // namespace
}  // namespace selfcal
