// The bus and the line of the virtual machine, and tests that run nowhere else.
#pragma once

#include <gtest/gtest.h>
#include <time.h>

#include <cstdlib>
#include <string>

#include "io/clock.h"

namespace selfcal {

/// As tests/hil/machine has set them up.
struct Wiring {
  std::string interface, robot_interface;  ///< the service's end of the bus and the robot's
  std::string chip, line, pull;            ///< the trigger's, and the file that drives it
};

inline std::string environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

inline Wiring wiring() {
  return {environment("SELFCAL_CAN_INTERFACE"), environment("SELFCAL_CAN_ROBOT"),
          environment("SELFCAL_GPIO_CHIP"), environment("SELFCAL_GPIO_LINE"),
          environment("SELFCAL_GPIO_PULL")};
}

/// A test that needs the virtual machine's kernel.
class InTheMachine : public testing::Test {
 protected:
  void SetUp() override {
    if (environment("SELFCAL_HIL_INSIDE").empty())
      GTEST_SKIP() << "runs in the virtual machine only: tests/hil/run";
  }
  const Wiring wires = wiring();
};

inline void step_wall_clock(Nanoseconds by) {
  const Nanoseconds t = realtime_now() + by;
  const timespec wall = {t / kSecond, t % kSecond};
  ASSERT_EQ(clock_settime(CLOCK_REALTIME, &wall), 0) << "needs root";
}

}  // namespace selfcal
