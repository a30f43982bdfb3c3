// What the loop stops, when, and what it leaves alone.
#include <gmock/gmock.h>

#include "tests/service/loop.h"

namespace selfcal {
namespace {

TEST_F(Loop, StopsTheRobotBeforeAnythingIsWritten) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  const std::unique_ptr<Store> beside = opened(scratch.folder());
  std::vector<std::string> held;
  robot.when_stopped = [&] { held.push_back(must(beside->remembered("held"))); };
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  ASSERT_FALSE(held.empty());
  EXPECT_EQ(held.front(), "") << "a disk may take seconds";
  EXPECT_EQ(must(beside->remembered("held")), "yes");
}

TEST_F(Loop, StopsAMoveOfAnEarlierLifeAndLeavesAloneARobotThatIsAtWorkSinceThen) {
  const Config cell = config();
  {
    const std::unique_ptr<Store> before = opened(scratch.folder());
    leave_session(*before, cell, robot.counts, "full", false);
    must(before->remember("held", "yes"));
    must(before->remember(kMoves, "yes"));
  }
  robot.working = true;
  start(cell);
  turn_for(kSecond);
  EXPECT_GT(robot.stops, 5) << "until it stands";
  robot.working = false;
  turn_for(2 * kSecond);
  EXPECT_EQ(must(opened(scratch.folder())->remembered(kMoves)), "");

  robot.working = true;
  robot.stops = 0;
  start(cell);
  turn_for(kSecond);
  EXPECT_EQ(robot.stops, 0) << "a restart in the middle of production";
}

TEST_F(Loop, KnowsThatAMoveMayBeUnderWayBeforeItAsksForIt) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  const std::unique_ptr<Store> beside = opened(scratch.folder());
  std::vector<std::string> moves;
  robot.when_asked = [&] { moves.push_back(must(beside->remembered(kMoves))); };
  person.say("start");
  ASSERT_TRUE(turning([&] { return !moves.empty(); }));
  EXPECT_EQ(moves.front(), "yes");
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(kSecond);
  EXPECT_EQ(must(beside->remembered(kMoves)), "");
}

TEST_F(Loop, KeepsSentencesThatTakeTurnsOnceAnHour) {
  ServiceContext context = context_of(config());
  for (int i = 0; i < 500; ++i) {
    context.now += 20 * kSecond;  // nearly three hours
    context.tell("error", i % 2 == 0 ? "the trigger is gone" : "no encoder reading");
  }
  journal.reset();
  EXPECT_EQ(must(store->events(100)).size(), 6u);
}

TEST_F(Loop, LeavesAloneWhatMovesByOthersOnceItsOwnMoveHasEnded) {
  const Config cell = config();
  leave_loaded_session(*opened(scratch.folder()), cell, robot.counts);
  robot.home[0] = 0.3;  // at the touch that was in progress
  robot.touching = robot.obeys = true;
  start(cell);
  ASSERT_TRUE(turning([&] { return !robot.asked.empty(); }));
  EXPECT_EQ(robot.asked, std::vector{MoveKind::retract});
  robot.touching = false;
  ASSERT_TRUE(comes_to(ServiceState::awaiting_person));
  robot.stops = 0;
  robot.working = true;  // by the hands of the person
  turn_for(kSecond);
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(kSecond);
  EXPECT_EQ(robot.stops, 0);
}

TEST_F(Loop, FaultsWhereMoreHappensAtOnceThanItCanHold) {
  ServiceContext context = context_of(config());
  for (int i = 0; i < 1024; ++i) context.put(Event::What::opened);
  EXPECT_EQ(context.lost_events, 0U);
  EXPECT_EQ(context.events.back().what, Event::What::opened);
  for (int i = 0; i < 5000; ++i) context.put(Event::What::closed);
  EXPECT_EQ(context.lost_events, 5000U);
  EXPECT_EQ(context.events.size(), 1025U) << "memory stays bounded";
  EXPECT_EQ(context.events.back().what, Event::What::broken);
  EXPECT_THAT(context.events.back().why, testing::HasSubstr("lost"));
}

TEST_F(Loop, StopsNoContactOfOthersAfterAnAbort) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(kSecond);
  robot.stops = 0;
  robot.touching = true;
  turn_for(kSecond);
  EXPECT_EQ(robot.stops, 0);
}

}  // namespace
}  // namespace selfcal
