// Two joints that take their positions at SYNC, a cycle every 10 ms. Times in microseconds.
#pragma once

#include <gtest/gtest.h>

#include "tests/can/bus.h"

namespace selfcal {

inline constexpr double kPeriod = 10'000;
inline constexpr CanTiming kTiming = {.cycle = 0, .window = 0.005, .delay = 0};

class Synced : public testing::Test {
 protected:
  double t(int cycle) const { return 1e6 + kPeriod * cycle; }
  /// A cycle in which a stands at 1000 + 10 k and b at -1000 - 10 k.
  void good(int k) {
    bus.sync(t(k));
    bus.frame(0, 1000 + 10 * k, t(k) + 200);
    bus.frame(1, -1000 - 10 * k, t(k) + 400);
  }
  /// Good cycles from `first` to before `last`.
  void run(int first, int last) {
    for (int k = first; k < last; ++k) good(k);
  }
  /// Ends the last cycle.
  void end(int k) { bus.sync(t(k)); }

  Bus bus{two_joints(true), kTiming};
};

}  // namespace selfcal
