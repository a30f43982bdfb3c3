// The machine's own clocks: CLOCK_MONOTONIC for stamps, CLOCK_REALTIME for people.
#pragma once

#include "io/ports.h"
#include "io/wakeup.h"

namespace selfcal {

/// CLOCK_MONOTONIC (ns).
Nanoseconds monotonic_now();
/// CLOCK_REALTIME (ns since 1970, UTC); may step.
Nanoseconds realtime_now();

class SystemClock : public Clock {
 public:
  /// `wakeup` must outlive the clock; its news end wait() early.
  explicit SystemClock(Wakeup& wakeup) : wakeup_(wakeup) {}
  Nanoseconds now() override;
  std::int64_t unix_ms() override;
  void wait(Nanoseconds longest) override;

 private:
  Wakeup& wakeup_;
};

}  // namespace selfcal
