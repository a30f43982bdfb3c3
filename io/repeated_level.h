// The level of a trigger as its publisher tells it, and whether that has ceased.
#pragma once

#include <cstdint>
#include <optional>

#include "io/clock.h"

namespace selfcal {

/// Of a publisher that tells of changes alone nobody knows whether it has hung; one that has
/// repeated its level for `silence` without a gap of it is missed.
class RepeatedLevel {
 public:
  explicit RepeatedLevel(Nanoseconds silence) : silence_(silence) {}

  void hear(bool level, std::uint64_t publisher, Nanoseconds now);
  /// Nothing of it for `silence` beyond the usual gaps: of a robot that is gone the joint states
  /// are missed first.
  bool has_ceased(Nanoseconds now) const {
    return repeats_ && now - heard_ > silence_ + 2 * longest_;
  }
  std::optional<bool> level() const { return level_; }  ///< the last one heard
  void forget() { level_.reset(); }                     ///< nobody tells it any more
  Nanoseconds silence() const { return silence_; }

 private:
  Nanoseconds silence_;
  std::optional<bool> level_;
  std::uint64_t publisher_ = 0;  ///< who told the last level
  Nanoseconds heard_ = 0;        ///< our time of it
  Nanoseconds same_since_ = 0;   ///< of the first of the same ones before it without a gap
  Nanoseconds longest_ = 0;      ///< of the gaps between the same ones
  bool repeats_ = false;
};

}  // namespace selfcal
