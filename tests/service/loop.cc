// What begins by itself while the robot is at other work, what waits for a person, and what is left
// of a session that did not begin.
#include "tests/service/loop.h"

#include <gmock/gmock.h>

#include "io/files/robot_file.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// A result that an earlier life has left to be accepted.
void leave_candidate(Store& store, const Robot& robot) {
  const std::int64_t id = must(store.begin(some_session(), some_plan(2, 6)));
  ResultRecord result = some_result(id);
  result.decision = ResultDecision::candidate;
  result.robot_text = robot_text(robot, values(robot));
  const SlotRecord candidate{id, id, model_hash(robot), result.robot_text};
  must(store.finish(result, &candidate));
}

TEST_F(Loop, GoesOnFromAPersonOnlyWhereTheWayHomeIsOpen) {
  const Config cell = config({{"motion.keep_out", "[{point: [-0.3, 0, 0], normal: [1, 0, 0]}]"}});
  leave_loaded_session(*opened(scratch.folder()), cell, robot.counts);
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::awaiting_person));
  const auto answer = [&] {
    person.replies.clear();
    person.say("done");
    turn_for(kSecond / 10);
    return person.replies.size() == 1 ? person.replies.front().why : "no answer";
  };

  robot.working = true;
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("does not stand still"));
  robot.working = false;
  robot.touching = true;
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("the trigger is closed"));
  robot.touching = false;
  robot.home[0] += 1.2;  // beyond that
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("no free way home"));
  EXPECT_EQ(state().state, ServiceState::awaiting_person);
  EXPECT_TRUE(robot.asked.empty());

  robot.home[0] -= 1.2;
  turn_for(kSecond);
  EXPECT_EQ(answer(), "done");
  EXPECT_EQ(robot.asked, std::vector{MoveKind::travel});
}

/// The edge comes before the robot says that it has arrived.
TEST_F(Loop, BacksOffToWhereAMoveBeganThatEndedInAContact) {
  const Config cell = config();
  leave_session(*opened(scratch.folder()), cell, robot.counts, "full", false);
  robot.obeys = true;
  robot.when_asked = [&] {
    if (robot.asked.size() != 2) return;
    robot.obeys = false;
    robot.touching = true;
    robot.edges.push_back({.time = robot.time, .closed = true});
  };
  robot.when_stopped = [&] {
    robot.replies.push_back({robot.last.id, MotionReply::Outcome::done, ""});
  };
  start(cell);
  ASSERT_TRUE(turning([&] { return robot.asked.size() == 3; }));
  EXPECT_EQ(robot.asked, (std::vector{MoveKind::travel, MoveKind::travel, MoveKind::retract}));
  EXPECT_EQ(robot.last.q, std::vector<double>(cell.plan.home.begin(), cell.plan.home.end()));
}

TEST_F(Loop, KeepsAResultWaitingThatTheStoreCouldNotAcceptOrReject) {
  const Config cell = config({{"commands.allow", "[accept, reject]"}});
  leave_candidate(*opened(scratch.folder()), *cell.robot);
  start(cell);
  for (const std::string verb : {"accept", "reject"}) {
    ASSERT_TRUE(comes_to(ServiceState::awaiting_acceptance));
    const std::string full = " ON slot BEGIN SELECT RAISE(FAIL, 'disk is full'); END;";
    change_store("CREATE TRIGGER a BEFORE UPDATE" + full + "CREATE TRIGGER b BEFORE DELETE" + full);
    person.replies.clear();
    person.say(verb);
    ASSERT_TRUE(comes_to(ServiceState::fault));
    ASSERT_EQ(person.replies.size(), 1) << verb;
    EXPECT_FALSE(person.replies.front().accepted) << verb;
    EXPECT_THAT(person.replies.front().why, HasSubstr("disk is full"));
    change_store("DROP TRIGGER a; DROP TRIGGER b");
  }
  ASSERT_TRUE(comes_to(ServiceState::awaiting_acceptance));
  person.say("accept");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_EQ(service->models().session(), 1);
}

TEST_F(Loop, SaysWhyItIsIdleOnceAResultWasRolledBack) {
  const Config cell = config({{"commands.allow", "[accept, rollback]"}});
  leave_candidate(*opened(scratch.folder()), *cell.robot);
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::awaiting_acceptance));
  person.say("accept");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("rollback");
  ASSERT_TRUE(turning([&] { return service->models().session() == 0; }));
  EXPECT_EQ(state().why, person.replies.back().why);
  EXPECT_THAT(state().why, HasSubstr("session 1 was rolled back"));
}

TEST_F(Loop, LeavesTheParametersOfAnotherRobotAsTheyAre) {
  const Config cell = config({{"commands.allow", "[rollback]"}});
  {
    const auto before = opened(scratch.folder());
    const std::int64_t id = before->begin(some_session(), some_plan(2, 6)).value();
    const SlotRecord other{id, id, std::string(64, 'f'), "robot: another"};
    ASSERT_TRUE(before->finish(some_result(id), &other).has_value());
    ASSERT_TRUE(before->accept(id).has_value());
  }
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("rollback");
  ASSERT_TRUE(turning([&] { return !person.replies.empty(); }));
  EXPECT_FALSE(person.replies.back().accepted);
  EXPECT_THAT(person.replies.back().why, HasSubstr("belongs to another robot"));
  EXPECT_EQ(must(store->slot(Slot::active))->model_hash, std::string(64, 'f'));
}

TEST_F(Loop, KeepsEachCommandThatItGrants) {
  start(config());
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(comes_to(ServiceState::idle));
    person.say("start");
    ASSERT_TRUE(comes_to(ServiceState::planning));
    person.say("abort");
  }
  ASSERT_TRUE(comes_to(ServiceState::idle));
  const auto kept = [&](const std::string& text) {
    const std::vector<EventRecord> events = must(store->events(50));
    return std::ranges::count(events, text, &EventRecord::text);
  };
  EXPECT_TRUE(turning([&] { return kept("command start from a test") == 2; }));
  EXPECT_TRUE(turning([&] { return kept("command abort from a test") == 2; }));
}

TEST_F(Loop, MakesNoTouchOfASessionThatWasGivenUpAtItsBeginning) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::planning));
  robot.working = true;
  ASSERT_TRUE(comes_to(ServiceState::fault));
  EXPECT_THAT(state().why, HasSubstr("does not stand still"));
  EXPECT_TRUE(state().unfinished);
  robot.working = false;
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_EQ(must(store->session(1)).state, SessionState::aborted);

  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_FALSE(state().unfinished);
  turn_for(kSecond);
  EXPECT_TRUE(robot.asked.empty());
}

TEST_F(Loop, TouchesNothingForAQuickCheckWhoseParametersWereRolledBack) {
  const Config cell = config();
  leave_session(*opened(scratch.folder()), cell, robot.counts, "check", false);
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::fault));
  EXPECT_THAT(state().why,
              HasSubstr("a quick check compares with an accepted session, and factory is active"));
  EXPECT_TRUE(robot.asked.empty());
  EXPECT_EQ(must(store->session(1)).state, SessionState::aborted);
  EXPECT_FALSE(state().unfinished) << "nothing is there that could be resumed";

  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_EQ(state().why, "ready");
}

TEST_F(Loop, BeginsNothingByItselfWhileTheRobotIsAtOtherWork) {
  start(config({{"schedule.every_hours", "0.001"}}));
  ASSERT_TRUE(comes_to(ServiceState::idle));
  robot.working = true;
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  const auto said_to_wait = [&] {
    const std::vector<EventRecord> events = must(store->events(20));
    return std::ranges::count_if(events, [](const EventRecord& event) {
      return event.text.find("waits until the robot has stood for 5 s") != std::string::npos;
    });
  };
  ASSERT_TRUE(turning([&] { return said_to_wait() == 1; }));
  turn_for(20 * kSecond);
  EXPECT_EQ(said_to_wait(), 1) << "once, and not every second";

  robot.working = false;
  turn_for(4 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle);
  ASSERT_TRUE(comes_to(ServiceState::planning));
  robot.working = true;
  ASSERT_TRUE(comes_to(ServiceState::idle)) << "once the touches are planned";
  EXPECT_FALSE(state().held);
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  EXPECT_TRUE(robot.asked.empty());

  robot.working = false;
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  EXPECT_EQ(state().session, 1) << "the one that was planned";
}

}  // namespace
}  // namespace selfcal
