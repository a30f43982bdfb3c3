// A wall clock that is wrong when the service begins, and is set while it runs.
#include <gmock/gmock.h>

#include "tests/service/loop.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kHour_ms = 3'600'000, kYears_ms = 10 * 365 * 24 * kHour_ms;

TEST_F(Loop, KeepsTheLastSessionsTimeUnderAClockThatIsNotSetYet) {
  const Config cell = config({{"schedule.every_hours", "24"}});
  const std::string last = std::to_string(robot.unix_ms() - kHour_ms);
  must(opened(scratch.folder())->remember("use", "5.0 " + last + " 4.0 nan 2"));
  robot.ahead_ms = -kYears_ms;
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(10 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  service->shut_down();
  EXPECT_THAT(must(store->remembered("use")), HasSubstr(" " + last + " "));

  start(cell);
  turn_for(10 * kSecond);
  robot.ahead_ms = 0;  // the network has told
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  service->shut_down();
  EXPECT_THAT(must(store->remembered("use")), HasSubstr(" " + last + " "));
  std::string said;
  ASSERT_TRUE(turning([&] {
    said.clear();
    for (const EventRecord& event : must(store->events(20))) said += event.text + "\n";
    return said.find("once more") != std::string::npos;
  }));
  EXPECT_THAT(said, AllOf(HasSubstr("the clock shows 2016-"), HasSubstr("by the clock")));
}

TEST_F(Loop, CountsTheHoursThatHavePassedWhereTheClockIsSetForward) {
  start(config({{"schedule.every_hours", "24"}}));
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(10 * kSecond);  // the interval has begun
  robot.ahead_ms = kYears_ms;
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
}

}  // namespace
}  // namespace selfcal
