#include "app/report/format.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <ctime>

namespace selfcal {
namespace {

std::tm local(std::int64_t unix_ms) {
  const auto t = static_cast<std::time_t>(unix_ms / 1000);
  std::tm parts{};
  localtime_r(&t, &parts);
  return parts;
}

bool same_day(const std::tm& a, const std::tm& b) {
  return a.tm_year == b.tm_year && a.tm_yday == b.tm_yday;
}

/// The next byte goes on with the character of those before.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

}  // namespace

std::string printed(const char* format, ...) {
  std::va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  std::string text(static_cast<std::size_t>(std::max(size, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return text;
}

std::int64_t unix_now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string clock_time(std::int64_t unix_ms) {
  const std::tm t = local(unix_ms);
  return printed("%02d:%02d:%02d", t.tm_hour, t.tm_min, t.tm_sec);
}

std::string date_time(std::int64_t unix_ms) {
  if (unix_ms == 0) return "-";
  const std::tm t = local(unix_ms);
  return printed("%04d-%02d-%02d %02d:%02d", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday, t.tm_hour,
                 t.tm_min);
}

std::string day_time(std::int64_t unix_ms, std::int64_t now_ms) {
  const std::tm then = local(unix_ms), now = local(now_ms);
  std::tm yesterday = now, tomorrow = now;
  yesterday.tm_hour = tomorrow.tm_hour = 12;  // far from the hour that the clock is put on or back
  --yesterday.tm_mday;
  ++tomorrow.tm_mday;
  std::mktime(&yesterday);
  std::mktime(&tomorrow);
  const std::string time = printed(" %02d:%02d", then.tm_hour, then.tm_min);
  if (same_day(then, now)) return "today" + time;
  if (same_day(then, yesterday)) return "yesterday" + time;
  if (same_day(then, tomorrow)) return "tomorrow" + time;
  return date_time(unix_ms);
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  const long long s = std::llround(std::clamp(seconds, 0.0, 1e12));
  if (s < 60) return printed("%lld s", s);
  if (s < 3600) return printed("%lld min %02lld s", s / 60, s % 60);
  if (s < 48 * 3600) return printed("%lld h %02lld min", s / 3600, s / 60 % 60);
  return printed("%lld days", s / 86400);
}

std::string mm(double metres) {
  if (!std::isfinite(metres)) return "-";
  const double value = 1e3 * metres;
  // Fixed notation with three digits that count, down to a nanometre.
  const int whole = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  return printed("%.*f", std::clamp(2 - whole, 0, 6), value);
}

std::string counted(std::int64_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  // U+0080 to U+009F steer some terminals.
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (line[i] == '\xc2' && static_cast<unsigned char>(line[i + 1]) < 0xa0)
      line[i] = line[i + 1] = ' ';
  return line;
}

int characters(std::string_view text) {
  return static_cast<int>(text.size() - std::ranges::count_if(text, continues));
}

std::string fitted(std::string_view text, int columns) {
  if (characters(text) <= columns) return std::string(text);
  if (columns < 1) return {};
  std::size_t end = 0;
  for (int kept = 0; kept < columns; ++end)
    if (!continues(text[end])) ++kept;
  --end;  // room for the mark
  return std::string(text.substr(0, end)) + "…";
}

std::string padded(std::string_view text, int columns) {
  return std::string(text) +
         std::string(static_cast<std::size_t>(std::max(0, columns - characters(text))), ' ');
}

}  // namespace selfcal
