// The machine's own clocks.

#include "io/clock.h"

#include <time.h>

namespace selfcal {
namespace {

Nanoseconds read(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

}  // namespace

Nanoseconds monotonic_now() { return read(CLOCK_MONOTONIC); }
Nanoseconds realtime_now() { return read(CLOCK_REALTIME); }

Nanoseconds SystemClock::now() { return monotonic_now(); }
std::int64_t SystemClock::unix_ms() { return realtime_now() / kMillisecond; }
void SystemClock::wait(Nanoseconds longest) { wakeup_.wait(longest); }

}  // namespace selfcal
