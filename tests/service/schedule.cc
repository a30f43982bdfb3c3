// When a session begins by itself. Moments are worked out from the calendar by hand: day 20000
// since 1970 (2024-10-04) began at 20000 * 86400 s UTC.
#include "app/service/config/schedule.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <ctime>

namespace selfcal {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMinute = 60'000, kHour = 60 * kMinute, kDay = 24 * kHour;
constexpr std::int64_t kMidnight = 20000 * kDay;  // UTC

Since since_at(std::int64_t unix_ms) {
  Since since;
  since.unix_ms = unix_ms;
  return since;
}

const UtcOffset kUtc = [](std::int64_t) { return 0; };

UtcOffset always(int offset_s) {
  return [offset_s](std::int64_t) { return offset_s; };
}

bool due_at(const Schedule& schedule, const Since& since, std::int64_t t, int offset_s = 0) {
  return due(schedule, since, t, std::nullopt, always(offset_s)).has_value();
}

TEST(Schedule, BeginsNothingByDefault) {
  EXPECT_FALSE(Schedule().any());
  EXPECT_FALSE(due_at({}, since_at(kMidnight), kMidnight + 1000 * kDay));
  EXPECT_EQ(next_due({}, since_at(kMidnight), kMidnight, kUtc), 0);
}

TEST(Schedule, IsDueEverySoManyHoursAfterTheLastOne) {
  Schedule schedule;
  schedule.every_hours = 12.5;
  const Since since = since_at(kMidnight);
  const std::int64_t then = kMidnight + 12 * kHour + 30 * kMinute;
  EXPECT_FALSE(due_at(schedule, since, then - 1));
  EXPECT_TRUE(due_at(schedule, since, then));
  EXPECT_EQ(next_due(schedule, since, kMidnight + kHour, kUtc), then);
  EXPECT_EQ(due(schedule, since, then, {}, kUtc)->why, "every 12.5 h");
}

TEST(Schedule, IsDueAtOnceWhenNothingHasEverBeenMeasured) {
  Schedule schedule;
  schedule.every_hours = 24;
  EXPECT_TRUE(due_at(schedule, {}, kMidnight));
  EXPECT_EQ(next_due(schedule, {}, kMidnight, kUtc), kMidnight);
}

TEST(Schedule, IsDueAtTheTimeOfDayAcrossMidnight) {
  Schedule schedule;
  schedule.at_minute = 2 * 60 + 30;
  const Since since = since_at(kMidnight - 2 * kHour);  // 22:00 the day before
  const std::int64_t then = kMidnight + 2 * kHour + 30 * kMinute;
  EXPECT_FALSE(due_at(schedule, since, kMidnight - kMinute));
  EXPECT_FALSE(due_at(schedule, since, then - 1));
  EXPECT_TRUE(due_at(schedule, since, then));
  EXPECT_TRUE(due_at(schedule, since, then + 5 * kHour)) << "late, when it was busy at the time";
  EXPECT_FALSE(due_at(schedule, since_at(then), then + kMinute)) << "once a day";
  EXPECT_FALSE(due_at(schedule, since_at(then), then + kDay - 1));
  EXPECT_TRUE(due_at(schedule, since_at(then), then + kDay));
}

TEST(Schedule, GoesByTheLocalTimeOfDay) {
  Schedule schedule;
  schedule.at_minute = 30;  // 00:30 local
  const int east = 2 * 3600, west = -5 * 3600;
  // East of Greenwich the local day begins before, west of it after the day of UTC.
  const std::int64_t there = kMidnight + 30 * kMinute - 2 * kHour;
  EXPECT_FALSE(due_at(schedule, since_at(there - kHour), there - 1, east));
  EXPECT_TRUE(due_at(schedule, since_at(there - kHour), there, east));
  const std::int64_t here = kMidnight + 30 * kMinute + 5 * kHour;
  EXPECT_FALSE(due_at(schedule, since_at(here - kHour), here - 1, west));
  EXPECT_TRUE(due_at(schedule, since_at(here - kHour), here, west));
  EXPECT_EQ(next_due(schedule, since_at(there - kHour), there - kHour, always(east)), there);
}

/// The clock of this process in Berlin, by the rule alone: no database of zones is needed.
class Berlin {
 public:
  Berlin() {
    if (const char* zone = getenv("TZ")) before_ = zone;
    setenv("TZ", "CET-1CEST,M3.5.0,M10.5.0/3", 1);
    tzset();
  }
  ~Berlin() {
    before_ ? setenv("TZ", before_->c_str(), 1) : unsetenv("TZ");
    tzset();
  }
  Berlin(const Berlin&) = delete;
  Berlin& operator=(const Berlin&) = delete;

 private:
  std::optional<std::string> before_;
};

/// When sessions of ten minutes begin, looked for every minute.
std::vector<std::int64_t> sessions_between(const Schedule& schedule, std::int64_t from,
                                           std::int64_t to) {
  std::vector<std::int64_t> began;
  Since since = since_at(from);
  for (std::int64_t t = from; t < to; t += kMinute) {
    if (!due(schedule, since, t, std::nullopt, utc_offset)) continue;
    began.push_back(t);
    since.unix_ms = t + 10 * kMinute;
  }
  return began;
}

TEST(Schedule, FollowsATimeZoneThatIsChangedWhileTheServiceRuns) {
  const Berlin berlin;
  ASSERT_EQ(utc_offset(kMidnight), 2 * 3600);
  setenv("TZ", "EST5", 1);
  EXPECT_EQ(utc_offset(kMidnight), -5 * 3600);
}

TEST(Schedule, IsDueOnceAtATimeOfDayThatComesTwiceInAutumn) {
  const Berlin berlin;
  Schedule schedule;
  schedule.at_minute = 2 * 60 + 30;
  const std::int64_t day = 20023 * kDay;  // 2024-10-27; at 01:00 UTC 03:00 becomes 02:00
  const std::int64_t first = day + 30 * kMinute;
  EXPECT_EQ(sessions_between(schedule, day - 12 * kHour, day + 12 * kHour), std::vector{first});
  EXPECT_EQ(sessions_between(schedule, day - 12 * kHour, day + 36 * kHour),
            (std::vector{first, first + 25 * kHour}))
      << "the next night by the time of the winter";
}

TEST(Schedule, IsDueOnceAtATimeOfDayThatIsLeftOutInSpring) {
  const Berlin berlin;
  Schedule schedule;
  schedule.at_minute = 2 * 60 + 30;
  const std::int64_t day = 20177 * kDay;  // 2025-03-30; at 01:00 UTC 02:00 becomes 03:00
  EXPECT_EQ(sessions_between(schedule, day - 24 * kHour, day + 36 * kHour),
            (std::vector{day - 24 * kHour + 90 * kMinute, day + kHour, day + kDay + 30 * kMinute}))
      << "at the first moment after the hour that does not exist";
}

TEST(Schedule, WaitsForTheTimeOfDayBeforeTheFirstSession) {
  Schedule schedule;
  schedule.at_minute = 2 * 60 + 30;
  const std::int64_t then = kMidnight + 2 * kHour + 30 * kMinute;
  EXPECT_EQ(next_due(schedule, {}, kMidnight, kUtc), then);
  EXPECT_FALSE(due_at(schedule, {}, then - 1));
  EXPECT_TRUE(due_at(schedule, {}, then)) << "what was announced also comes";
  EXPECT_FALSE(due_at(schedule, {}, kMidnight + 12 * kHour)) << "not whenever it is switched on";
}

TEST(Schedule, MakesNothingDueByAClockThatIsNotBelieved) {
  Schedule schedule;
  schedule.every_hours = 24;
  schedule.at_minute = 60;
  Since since = since_at(kMidnight - 100 * kDay);
  since.dated = false;
  EXPECT_FALSE(due_at(schedule, since, kMidnight + kHour));
  EXPECT_EQ(next_due(schedule, since, kMidnight, kUtc), 0);
  schedule.after_motion_hours = 10;
  since.motion_hours = 11;
  EXPECT_TRUE(due_at(schedule, since, kMidnight + kHour)) << "what does not go by the clock";
}

TEST(Schedule, WaitsForTheNextTimeOfDayAfterTheClockWasSetPastOne) {
  Schedule schedule;
  schedule.at_minute = 2 * 60 + 30;
  Since since = since_at(kMidnight - 22 * kHour);
  since.set_to_ms = kMidnight + 8 * kHour;
  const std::int64_t then = kMidnight + kDay + 2 * kHour + 30 * kMinute;
  EXPECT_FALSE(due_at(schedule, since, kMidnight + 8 * kHour));
  EXPECT_FALSE(due_at(schedule, since, then - 1));
  EXPECT_TRUE(due_at(schedule, since, then));
  EXPECT_EQ(next_due(schedule, since, kMidnight + 8 * kHour, kUtc), then);
}

TEST(Schedule, DoesNotBeginAgainWhenTheClockIsSetBackByASecond) {
  Schedule schedule;
  schedule.every_hours = 24;
  EXPECT_FALSE(due_at(schedule, since_at(kMidnight + 1000), kMidnight));
}

TEST(Schedule, IsDueAfterHoursOfMotion) {
  Schedule schedule;
  schedule.after_motion_hours = 100;
  Since since = since_at(kMidnight);
  since.motion_hours = 99.9;
  EXPECT_FALSE(due_at(schedule, since, kMidnight + kDay));
  since.motion_hours = 100;
  EXPECT_EQ(due(schedule, since, kMidnight, {}, kUtc)->why, "after 100 h of motion");
  EXPECT_EQ(next_due(schedule, since, kMidnight, kUtc), 0) << "the clock alone does not tell";
}

TEST(Schedule, IsDueWhenTheTemperatureHasMovedEitherWay) {
  Schedule schedule;
  schedule.temperature_change = 4;
  Since since = since_at(kMidnight);
  EXPECT_FALSE(due(schedule, since, kMidnight, 30.0, kUtc)) << "not known what it was";
  since.temperature = 20;
  EXPECT_FALSE(due(schedule, since, kMidnight, std::nullopt, kUtc));
  EXPECT_FALSE(due(schedule, since, kMidnight, 23.9, kUtc));
  EXPECT_THAT(due(schedule, since, kMidnight, 24.0, kUtc)->why, HasSubstr("4 K"));
  EXPECT_THAT(due(schedule, since, kMidnight, 15.5, kUtc)->why, HasSubstr("-4.5 K"));
}

TEST(Schedule, ChecksFirstAndTakesAFullSessionAfterSoManyChecks) {
  Schedule schedule;
  schedule.every_hours = 1;
  schedule.full_after_checks = 3;
  Since since = since_at(kMidnight);
  const auto kind = [&] { return due(schedule, since, kMidnight + kDay, {}, kUtc)->kind; };
  EXPECT_EQ(kind(), SessionKind::full) << "there is nothing that a check could test";
  since.calibrated = true;
  EXPECT_EQ(kind(), SessionKind::check);
  since.checks = 2;
  EXPECT_EQ(kind(), SessionKind::check);
  since.checks = 3;
  EXPECT_EQ(kind(), SessionKind::full);
  since.checks = 0;
  schedule.check_first = false;
  EXPECT_EQ(kind(), SessionKind::full);
}

}  // namespace
}  // namespace selfcal
