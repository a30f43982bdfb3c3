// From stamps of the wall clock (CLOCK_REALTIME) to the time base (CLOCK_MONOTONIC).
//
//   offset = monotonic - wall lies in [before - wall, after - wall]
//
// for a wall reading taken between two monotonic ones. The kernel derives both clocks from one
// counter and slews them together, so that the offset is constant, and only a step of the wall
// clock changes it. Therefore the intervals of all readings since the last step hold the same
// offset: their intersection is at least as tight as the tightest of them, and an empty one is a
// step, however small. What was stamped around a step is given up: nobody can tell on which side of
// it a stamp lies.
#pragma once

#include <optional>

#include "io/ports.h"

namespace selfcal {

/// The wall clock read between two readings of the monotonic one (ns).
struct ClockReading {
  Nanoseconds before = 0, wall = 0, after = 0;
};

/// The tightest of `tries` readings, 1 at least.
ClockReading read_clocks(int tries = 5);

class WallClock {
 public:
  /// Two processors' counters may disagree by so much without any step.
  static constexpr Nanoseconds kSlack = 1000;
  /// A stamp is older than its delivery by less than this, or it is of another time.
  static constexpr Nanoseconds kOldest = 2 * kSecond;
  /// For so long after a step was seen no stamp is trusted: the kernel stamps first and queues
  /// then.
  static constexpr Nanoseconds kSettle = 20 * kMillisecond;

  /// Tells a reading that was taken after some stamps were received, and whether none is waiting
  /// any more (`drained`). Those stamps are converted next, before the following call.
  void observe(const ClockReading& reading, bool drained);
  /// A wall stamp on the time base; nothing around a step of the wall clock, or when it cannot have
  /// been taken within kOldest before the last reading.
  std::optional<Nanoseconds> monotonic(Nanoseconds wall) const;
  /// Half the width of what the offset may be (ns).
  Nanoseconds uncertainty() const { return (latest_ - earliest_) / 2; }
  std::uint64_t steps() const { return steps_; }

 private:
  bool known_ = false, trusted_ = false;
  Nanoseconds earliest_ = 0, latest_ = 0;  ///< bounds of monotonic - wall
  Nanoseconds now_ = 0;                    ///< monotonic, of the last reading
  Nanoseconds settled_ = 0;                ///< from when on stamps are trusted again
  bool waiting_ = false;                   ///< stamps from before the step may still wait
  std::uint64_t steps_ = 0;
};

}  // namespace selfcal
