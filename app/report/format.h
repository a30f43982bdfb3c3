// Numbers, times and lengths of time in words for a person, and texts made fit for one line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace selfcal {

/// printf into a string, of any length.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

/// ms since 1970 (UTC), by the computer's clock.
std::int64_t unix_now_ms();
/// "14:02:31", local time; `unix_ms` is ms since 1970 (UTC).
std::string clock_time(std::int64_t unix_ms);
/// "2026-11-20 14:02", local time; "-" for 0.
std::string date_time(std::int64_t unix_ms);
/// "today 14:02", "yesterday 02:30", "tomorrow 02:30" or the date, as seen at `now_ms`.
std::string day_time(std::int64_t unix_ms, std::int64_t now_ms);
/// "45 s", "3 min 20 s", "2 h 05 min", "12 days".
std::string duration(double seconds);
/// Millimetres with three significant digits of a length in m; "-" for NaN.
std::string mm(double metres);

/// "1 row", "12 rows".
std::string counted(std::int64_t count, std::string_view one);

/// The text without control characters, which come as blanks: what others send must not steer a
/// terminal.
std::string one_line(std::string_view text);
/// Characters, of which a UTF-8 text has fewer than bytes.
int characters(std::string_view text);
/// At most `columns` characters; a longer text ends in "…".
std::string fitted(std::string_view text, int columns);
/// The text followed by blanks up to `columns` characters.
std::string padded(std::string_view text, int columns);

}  // namespace selfcal
