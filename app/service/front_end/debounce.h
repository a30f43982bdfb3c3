// From a chattering contact to a level and the moment at which it was first met.
//
// A new level counts once nothing has changed for `quiet`; its moment is that of the first edge of
// the burst. A burst that ends at the old level is a glitch; one that does not end within five
// times `quiet` counts as closed, which is the safe side. A line with burst upon burst chatters.
#pragma once

#include <deque>
#include <optional>

#include "io/ports.h"

namespace selfcal {

class Debouncer {
 public:
  explicit Debouncer(Nanoseconds quiet) : quiet_(quiet) {}

  /// The level from which edges are counted.
  void begin(bool closed);
  /// One edge, in the order of time, and when it was heard of; an edge to the level that already is
  /// says nothing. Quiet is counted from the hearing: stamps may come from another clock.
  void add(const Edge& edge, Nanoseconds heard);
  /// The level as the port has it: where edges were lost it begins a burst that is not
  /// timed.
  void reconcile(bool closed, Nanoseconds now);
  /// The level that has held since, if it is a new one.
  std::optional<Edge> settled(Nanoseconds now);
  /// When to ask again; nothing while no burst is under way.
  std::optional<Nanoseconds> settles_in(Nanoseconds now) const;
  std::uint64_t glitches() const { return glitches_; }
  /// Far more bursts within the last second than touches can make.
  bool chatters(Nanoseconds now) const {
    return ends_.size() == kChatter && now - ends_.front() <= kSecond;
  }

 private:
  static constexpr std::size_t kChatter = 16;
  void end_burst(Nanoseconds now);

  Nanoseconds quiet_;
  bool level_ = false, raw_ = false;
  std::optional<Nanoseconds> burst_;  ///< its first edge
  bool timed_ = true;                 ///< as its first edge
  Nanoseconds last_ = 0, heard_ = 0;  ///< of the last edge: stamp, hearing
  Nanoseconds burst_heard_ = 0;
  std::uint64_t glitches_ = 0;
  std::deque<Nanoseconds> ends_;  ///< of the last bursts, as they were heard
};

}  // namespace selfcal
