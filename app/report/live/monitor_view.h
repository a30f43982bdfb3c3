// What was heard of a service, and its picture in lines of text. Knows no DDS and no terminal.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "io/messages.h"

namespace selfcal {

inline constexpr double kSilence = 3;  ///< s without a status, which comes every second
inline constexpr std::size_t kTouchesShown = 8;

/// The last that was heard.
struct Watched {
  std::string robot;
  std::optional<StatusMessage> status;
  std::optional<ProgressMessage> progress;
  std::deque<ProgressMessage> touches;  ///< of one session, oldest first, at most kTouchesShown
  std::optional<ResultMessage> result;
  std::vector<HealthMessage> health;
  double silent = 0;  ///< s since the last status
};

void note(Watched& watched, const StatusMessage& status);
void note(Watched& watched, const ProgressMessage& progress);
void note(Watched& watched, const ResultMessage& result);

enum class Tone : std::uint8_t { plain, strong, good, warning, bad };

struct Line {
  std::string text;
  Tone tone = Tone::plain;
  int rank = 0;  ///< where room is short, the lines of the greatest rank go first
};

/// At most `rows` lines of at most `columns` characters. Times are told as seen at `now_ms`.
std::vector<Line> picture(const Watched& watched, std::int64_t now_ms, int columns, int rows);

/// The line as a terminal shows it, in its colour.
std::string painted(const Line& line);

/// Pieces of the picture that are also told line by line: "+12.3 µm" or "put aside: why", "62 of
/// 240 touches, 1 put aside, 3 min 20 s left", "improved, applied", and the result's figures
/// (empty when it has none).
std::string in_words(const ProgressMessage& touch);
std::string how_far(const ProgressMessage& progress);
std::string figures(const ResultMessage& result);
std::string counts(const ResultMessage& result);

}  // namespace selfcal
