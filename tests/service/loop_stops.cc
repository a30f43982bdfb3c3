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
  Config cell = config();
  store = opened(scratch.folder());
  journal = std::make_unique<Journal>(opened(scratch.folder()));
  Models models = must(Models::load(cell.robot, *store));
  ServiceContext context{std::move(cell), Ports{&robot, &robot, &robot, &robot},
                         person,          *store,
                         *journal,        std::move(models)};
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
