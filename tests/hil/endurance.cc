// 1 000 frames a second of each of six joints and 50 edges a second, for as many minutes as
// SELFCAL_MINUTES says, at a service in a process of its own: nothing is dropped, and what it
// costs.
#include <gtest/gtest.h>

#include <map>

#include "io/clock.h"
#include "tests/hil/bus_cell.h"
#include "tests/hil/spinning_arm.h"

namespace selfcal {
namespace {

/// The values of all diagnostic lines, as "selfcal: encoders dropped".
std::map<std::string, std::string> values_of(const HealthReport& report) {
  std::map<std::string, std::string> values;
  for (const HealthMessage& line : report.lines)
    for (const auto& [key, value] : line.values) values[line.name + " " + key] = value;
  return values;
}

class Endurance : public InTheMachine {};

TEST_F(Endurance, DropsNothing) {
  const int minutes = repetitions("SELFCAL_MINUTES", 1);
  CellOptions options = small_session();
  options.id = "lasting";
  BusCell cell(options, wires, wires);
  SpinningArmOptions pace;
  pace.touch_every = 40 * kMillisecond;
  const SpinningArm arm(wires, pace);
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return !cell.health.empty(); }));
  const Nanoseconds began = monotonic_now(), end = began + minutes * 60 * kSecond;
  const double used = cpu_seconds(cell.service_pid());
  while (monotonic_now() < end) {
    ASSERT_TRUE(cell.service_lives()) << cell.log();
    Wakeup().wait(kSecond);
    cell.listen();
    if (cell.health.size() > 10) cell.health.erase(cell.health.begin(), cell.health.end() - 1);
  }
  const double share = (cpu_seconds(cell.service_pid()) - used) / seconds(monotonic_now() - began);
  ASSERT_FALSE(cell.health.empty());
  const auto values = values_of(cell.health.back());
  for (const auto& [key, value] : values)
    if (key.find("store") == std::string::npos && key.find("calibration") == std::string::npos)
      std::printf("%s: %s\n", key.c_str(), value.c_str());
  std::printf(
      "%d min: the service used %.1f %% of the emulated processor (500 million "
      "instructions a second)\n",
      minutes, 100 * share);
  EXPECT_EQ(values.at("selfcal: encoders dropped"), "0");
  EXPECT_EQ(values.at("selfcal: trigger dropped"), "0");
  EXPECT_NEAR(std::stod(values.at("selfcal: encoders rate_hz")), 1000, 5);
}

}  // namespace
}  // namespace selfcal
