// A wall clock that is old when the service begins, or is set while it runs. Moments are those of a
// true clock; `ahead` is by how much the wall clock is ahead of it.
#include "app/service/config/calendar.h"

#include <gmock/gmock.h>

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kHour_ms = 3'600'000, kDay_ms = 24 * kHour_ms, kYear_ms = 365 * kDay_ms;
constexpr std::int64_t kTrue_ms = 20000 * kDay_ms;

/// The clocks so long (ms) after the start, at kTrue_ms.
void look_at(Calendar& calendar, std::int64_t after, std::int64_t ahead = 0) {
  calendar.look((after + kHour_ms) * kMillisecond, kTrue_ms + after + ahead);
}

Calendar calendar_of(std::int64_t last, std::int64_t latest, std::int64_t ahead = 0) {
  Calendar calendar;
  calendar.recall(last, latest);
  look_at(calendar, 0, ahead);
  return calendar;
}

TEST(CalendarOfTheService, BelievesAClockThatGoesOnFromWhatIsRecorded) {
  const Calendar fresh = calendar_of(0, 0);
  EXPECT_TRUE(fresh.believed());
  EXPECT_EQ(fresh.last_session_ms(), 0);
  const Calendar calendar = calendar_of(kTrue_ms - kDay_ms, kTrue_ms - kHour_ms);
  EXPECT_TRUE(calendar.believed());
  EXPECT_EQ(calendar.doubt(), "");
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms - kDay_ms);
  EXPECT_EQ(calendar.set_to_ms(), 0) << "a session may be late";
  EXPECT_EQ(calendar.latest_ms(), kTrue_ms);
  EXPECT_TRUE(calendar_of(kTrue_ms, kTrue_ms, -1000).believed()) << "set right by a second";
}

TEST(CalendarOfTheService, KeepsWhatIsRecordedUnderAClockFromBeforeIt) {
  const std::int64_t last = kTrue_ms - kDay_ms;
  Calendar calendar = calendar_of(last, last + kHour_ms, -kYear_ms);
  EXPECT_FALSE(calendar.believed());
  EXPECT_THAT(calendar.doubt(), AllOf(HasSubstr("2023-10"), HasSubstr("2024-10")));
  calendar.session_ended();  // that a person has begun
  EXPECT_EQ(calendar.last_session_to_keep_ms(), last);
  EXPECT_EQ(calendar.latest_ms(), last + kHour_ms);

  look_at(calendar, kHour_ms);  // the network has told
  EXPECT_TRUE(calendar.believed());
  EXPECT_EQ(calendar.set_to_ms(), kTrue_ms + kHour_ms) << "no time of day before it has come";
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms) << "an hour ago";
  EXPECT_EQ(calendar.last_session_to_keep_ms(), kTrue_ms);
}

TEST(CalendarOfTheService, MovesWhatThisLifeHasSeenWhereTheClockIsSetForward) {
  const std::int64_t last = kTrue_ms - kDay_ms;
  Calendar calendar = calendar_of(last, last);
  look_at(calendar, kHour_ms, kYear_ms);
  EXPECT_EQ(calendar.last_session_ms(), last) << "another life's, whose clock is not known";
  EXPECT_EQ(calendar.set_to_ms(), kTrue_ms + kHour_ms + kYear_ms);
  calendar.session_ended();
  look_at(calendar, 2 * kHour_ms, 2 * kYear_ms);
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms + kHour_ms + 2 * kYear_ms);
}

TEST(CalendarOfTheService, BelievesAClockThatIsSetBackWhileItRuns) {
  Calendar calendar = calendar_of(kTrue_ms + kYear_ms - kDay_ms, 0, kYear_ms);
  look_at(calendar, kHour_ms);
  EXPECT_TRUE(calendar.believed());
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms - kDay_ms) << "as long ago as it was";
  EXPECT_EQ(calendar.latest_ms(), kTrue_ms + kHour_ms);
}

TEST(CalendarOfTheService, LeavesASessionWhereItIsWhenTheClockIsSetBackByLittle) {
  Calendar calendar = calendar_of(0, 0);
  calendar.session_ended();
  look_at(calendar, kHour_ms / 2, -kHour_ms);
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms) << "no time of day comes twice";
}

TEST(CalendarOfTheService, TakesAClockAsItIsThatNobodySetsForADay) {
  Calendar calendar = calendar_of(kTrue_ms + kYear_ms, 0);
  look_at(calendar, kDay_ms - kHour_ms);
  EXPECT_FALSE(calendar.believed());
  look_at(calendar, kDay_ms);
  EXPECT_TRUE(calendar.believed());
  EXPECT_EQ(calendar.last_session_ms(), kTrue_ms + kDay_ms) << "the interval begins now";
  EXPECT_EQ(calendar.latest_ms(), kTrue_ms + kDay_ms);
}

}  // namespace
}  // namespace selfcal
