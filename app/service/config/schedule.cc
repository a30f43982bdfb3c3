#include "app/service/config/schedule.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace selfcal {
namespace {

constexpr std::int64_t kMinute = 60'000, kHour = 60 * kMinute, kDay = 24 * kHour;
constexpr std::int64_t kJustNow = 10 * kMinute;

// A wall clock that was set back must not put the next session off for years.
bool ahead(const Since& since, std::int64_t unix_ms) { return since.unix_ms > unix_ms + kHour; }

/// First moment after `from` at which the local clock shows the minute of the day.
std::int64_t next_at(int minute, std::int64_t from, int utc_offset_s) {
  const std::int64_t offset = std::int64_t{utc_offset_s} * 1000;
  const std::int64_t midnight = (from + offset) / kDay * kDay - offset;
  const std::int64_t today = midnight + minute * kMinute;
  return today > from ? today : today + kDay;
}

std::string hours(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

int utc_offset(std::int64_t unix_ms) {
  const std::time_t t = unix_ms / 1000;
  std::tm local{};
  localtime_r(&t, &local);
  return static_cast<int>(local.tm_gmtoff);
}

std::int64_t next_due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                      int utc_offset_s) {
  const bool unknown = since.unix_ms == 0 || ahead(since, unix_ms);
  std::int64_t next = 0;
  const auto earlier = [&](std::int64_t t) { next = next == 0 ? t : std::min(next, t); };
  if (schedule.every_hours)
    earlier(unknown ? unix_ms : since.unix_ms + std::llround(*schedule.every_hours * kHour));
  if (schedule.at_minute)
    earlier(next_at(*schedule.at_minute, unknown ? unix_ms : since.unix_ms, utc_offset_s));
  return next;
}

std::optional<Due> due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                       std::optional<double> temperature, int utc_offset_s) {
  std::string why;
  const bool unknown = since.unix_ms == 0 || ahead(since, unix_ms);
  if (schedule.every_hours &&
      (unknown || static_cast<double>(unix_ms - since.unix_ms) >= *schedule.every_hours * kHour))
    why = "every " + hours(*schedule.every_hours) + " h";
  if (schedule.at_minute &&
      next_at(*schedule.at_minute, unknown ? unix_ms - kJustNow : since.unix_ms, utc_offset_s) <=
          unix_ms)
    why = "at the time of day";
  if (schedule.after_motion_hours && since.motion_hours >= *schedule.after_motion_hours)
    why = "after " + hours(since.motion_hours) + " h of motion";
  if (schedule.temperature_change && temperature && since.temperature &&
      std::abs(*temperature - *since.temperature) >= *schedule.temperature_change)
    why = "the temperature moved by " + hours(*temperature - *since.temperature) + " K";
  if (why.empty()) return std::nullopt;
  const bool check =
      schedule.check_first && since.calibrated && since.checks < schedule.full_after_checks;
  return Due{check ? SessionKind::check : SessionKind::full, why};
}

}  // namespace selfcal
