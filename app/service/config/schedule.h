// When a session begins by itself, as a pure function of what has happened since the last one.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "app/service/transitions/state.h"

namespace selfcal {

struct Schedule {
  std::optional<double> every_hours;
  std::optional<int> at_minute;  ///< of the local day
  std::optional<double> after_motion_hours;
  std::optional<double> temperature_change;  ///< K
  bool check_first = true;
  int check_touches = 12;
  double check_p = 0.01;
  int full_after_checks = 30;
  bool any() const { return every_hours || at_minute || after_motion_hours || temperature_change; }
  bool by_clock() const { return every_hours || at_minute; }
};

/// What the schedule is measured against; unknown ones are missing.
struct Since {
  std::int64_t unix_ms = 0;           ///< of the last session or check; 0 before the first
  double motion_hours = 0;            ///< since then
  std::optional<double> temperature;  ///< at that time
  int checks = 0;                     ///< since the last full session
  bool calibrated = false;            ///< the active parameters come from a session
  bool dated = true;                  ///< the clock is believed; else it makes nothing due
  std::int64_t set_to_ms = 0;         ///< no time of day up to it has come: the clock was set
};

struct Due {
  SessionKind kind = SessionKind::full;
  std::string why;
};

/// By how much local time is ahead of UTC (s) at a moment (ms since 1970).
using UtcOffset = std::function<int(std::int64_t unix_ms)>;

/// As the system has it.
int utc_offset(std::int64_t unix_ms);

/// What is due now, if anything. A time of day is the first moment of a local day at which the
/// clock shows it, or has passed it: one that comes twice is due once, and one that is left out at
/// the end of the gap.
std::optional<Due> due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                       std::optional<double> temperature, const UtcOffset& offset);

/// When the clock alone makes the next one due (ms since 1970); 0 when it never does.
std::int64_t next_due(const Schedule& schedule, const Since& since, std::int64_t unix_ms,
                      const UtcOffset& offset);

}  // namespace selfcal
