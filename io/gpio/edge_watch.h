// From what the kernel reports of a line to edges that alternate, with what was lost on the way.
//
// The kernel keeps 16 edges for a reader and drops silently beyond; where edges are numbered a gap
// tells (libgpiod 2), else two edges to one level do, or a queue that was full: of how many it may
// hide one is counted. The kernel also reads the level a little after it has taken the stamp: a
// contact that opens again within that time reports "open" twice, and the closing between the two
// belongs at the stamp of the second. An edge whose stamp may be another's is passed on as not
// timed, and counts for safety but not as a measurement.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "io/gpio/line.h"

namespace selfcal {

class EdgeWatch {
 public:
  static constexpr std::size_t kQueue = 16;  ///< edges that the kernel keeps
  /// Watched for so long before the level counts as known: a chattering line is to be seen first.
  static constexpr Nanoseconds kWatchFirst = 600 * kMillisecond;
  /// A line chatters with so many changes within half a second; those of one bounce count once.
  static constexpr std::size_t kChatter = 40;
  static constexpr Nanoseconds kChatterSpan = kSecond / 2;
  static constexpr Nanoseconds kBounce = 5 * kMillisecond;
  /// Chattering and overruns are told of for so long after they were last seen.
  static constexpr Nanoseconds kTellFor = 3 * kSecond;

  EdgeWatch(bool closed, Nanoseconds now) : level_(closed), began_(now) {}

  /// What one reading of the kernel's queue gave; appends the edges.
  void add(const std::vector<LineEvent>& events, Nanoseconds now, std::vector<Edge>& out);
  /// The level as read while no edge waited; appends an edge, not timed, when one was lost. Two
  /// checks in a row must agree, as the edge may be on its way.
  void check(bool closed, Nanoseconds now, std::vector<Edge>& out);
  /// True while the level should be checked at once.
  bool suspicious() const { return gap_ || mismatch_; }

  /// Nothing while the line has not been watched for long enough.
  std::optional<bool> closed(Nanoseconds now) const;
  /// At least so many, where edges are not numbered.
  std::uint64_t lost() const { return lost_; }
  std::string trouble(Nanoseconds now) const;

 private:
  void count(Nanoseconds time);

  bool level_;
  Nanoseconds began_;
  std::uint64_t number_ = 0, lost_ = 0;
  bool gap_ = false;       ///< edges may be missing before the next one
  bool mismatch_ = false;  ///< the last check found another level
  bool foreign_ = false;   ///< stamps are of another clock
  std::deque<Nanoseconds> changes_;
  std::optional<Nanoseconds> chattered_;  ///< last
  std::optional<Nanoseconds> overran_;    ///< last: the kernel's queue was full
};

}  // namespace selfcal
