// From stamps of the wall clock to the time base.

#include "io/wall_clock.h"

#include <algorithm>

#include "io/clock.h"

namespace selfcal {

ClockReading read_clocks(int tries) {
  ClockReading best;
  for (int i = 0; i < tries; ++i) {
    ClockReading reading;
    reading.before = monotonic_now();
    reading.wall = realtime_now();
    reading.after = monotonic_now();
    if (i == 0 || reading.after - reading.before < best.after - best.before) best = reading;
  }
  return best;
}

void WallClock::observe(const ClockReading& reading, bool drained) {
  const Nanoseconds earliest = reading.before - reading.wall, latest = reading.after - reading.wall;
  now_ = reading.after;
  const bool stepped = known_ && (earliest > latest_ + kSlack || latest < earliest_ - kSlack);
  if (stepped) {
    ++steps_;
    settled_ = reading.after + kSettle;
    waiting_ = true;
  }
  const Nanoseconds narrowed_from = std::max(earliest, earliest_);
  const Nanoseconds narrowed_to = std::min(latest, latest_);
  const bool narrower = known_ && !stepped && narrowed_from <= narrowed_to;
  earliest_ = narrower ? narrowed_from : earliest;
  latest_ = narrower ? narrowed_to : latest;
  known_ = true;
  trusted_ = !waiting_;
  // What comes after the queue was empty and the time of stamping over is of the new time.
  if (drained && now_ >= settled_) waiting_ = false;
}

std::optional<Nanoseconds> WallClock::monotonic(Nanoseconds wall) const {
  if (!known_ || !trusted_) return std::nullopt;
  const Nanoseconds t = wall + earliest_ + (latest_ - earliest_) / 2;
  // A step there and back between two readings shows in the stamps alone.
  if (t < now_ - kOldest || t > now_ + (latest_ - earliest_) + kSlack) return std::nullopt;
  return t;
}

}  // namespace selfcal
