#include "app/service/config/schedule.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace selfcal {
namespace {

constexpr std::int64_t kMinute = 60'000, kHour = 60 * kMinute, kDay = 24 * kHour;
constexpr std::int64_t kJustNow = 10 * kMinute;

/// First moment at which the local clock, which is set at most once about then, shows `local` (ms
/// since 1970 of a clock that runs as UTC does) or more.
std::int64_t first_at(std::int64_t local, const UtcOffset& offset) {
  const int before = offset(local - kDay), after = offset(local + kDay);
  const std::int64_t unchanged = local - std::int64_t{before} * 1000;
  if (before == after) return unchanged;
  std::int64_t earlier = local - kDay, set = local + kDay;
  while (set - earlier > 1) {
    const std::int64_t middle = earlier + (set - earlier) / 2;
    (offset(middle) == before ? earlier : set) = middle;
  }
  return unchanged < set ? unchanged : std::max(set, local - std::int64_t{after} * 1000);
}

/// First moment after `from` at which a local day comes to the minute.
std::int64_t next_at(int minute, std::int64_t from, const UtcOffset& offset) {
  const std::int64_t today = (from + std::int64_t{offset(from)} * 1000) / kDay * kDay;
  for (std::int64_t day = today - kDay;; day += kDay)
    if (const std::int64_t t = first_at(day + minute * kMinute, offset); t > from) return t;
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
  tzset();  // the zone may have been changed since
  localtime_r(&t, &local);
  return static_cast<int>(local.tm_gmtoff);
}

std::int64_t next_due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                      const UtcOffset& offset) {
  const bool unknown = since.unix_ms == 0;
  if (!since.dated) return 0;
  std::int64_t next = 0;
  const auto earlier = [&](std::int64_t t) { next = next == 0 ? t : std::min(next, t); };
  if (schedule.every_hours)
    earlier(unknown ? unix_ms : since.unix_ms + std::llround(*schedule.every_hours * kHour));
  if (schedule.at_minute)
    earlier(next_at(*schedule.at_minute,
                    std::max(unknown ? unix_ms : since.unix_ms, since.set_to_ms), offset));
  return next;
}

std::optional<Due> due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                       std::optional<double> temperature, const UtcOffset& offset) {
  std::string why;
  const bool unknown = since.unix_ms == 0;
  if (schedule.every_hours && since.dated &&
      (unknown || static_cast<double>(unix_ms - since.unix_ms) >= *schedule.every_hours * kHour))
    why = "every " + hours(*schedule.every_hours) + " h";
  const std::int64_t from = std::max(unknown ? unix_ms - kJustNow : since.unix_ms, since.set_to_ms);
  if (schedule.at_minute && since.dated && next_at(*schedule.at_minute, from, offset) <= unix_ms)
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
