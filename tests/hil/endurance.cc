// 1 000 frames a second of each of six joints and 50 edges a second, for as many minutes as
// SELFCAL_MINUTES says, at a service in a process of its own: all of them arrive, nothing is
// dropped, and what it costs.
//
// What arrived is added up from what the service publishes each second: its rate of samples, and
// the glitches of its trigger. Each closing is shorter than the debouncing, and so one glitch.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "io/clock.h"
#include "tests/hil/bus_cell.h"
#include "tests/hil/spinning_arm.h"

namespace selfcal {
namespace {

using Values = std::map<std::string, std::string>;

/// The values of all diagnostic lines, as "selfcal: encoders dropped".
Values values_of(const HealthReport& report) {
  Values values;
  for (const HealthMessage& line : report.lines)
    for (const auto& [key, value] : line.values) values[line.name + " " + key] = value;
  return values;
}

double number(const Values& values, const std::string& key) {
  const auto found = values.find("selfcal: " + key);
  EXPECT_NE(found, values.end()) << key;
  return found == values.end() ? 0 : std::stod(found->second);
}

/// What arrived from the first report to the last, added up.
struct Arrived {
  double seconds = 0, samples = 0, touches = 0;
  double slowest = 1e9;  ///< second (Hz)
  Values last;           ///< report, and its time
  std::int64_t last_ms = 0;

  void add(const HealthReport& report) {
    const Values values = values_of(report);
    if (!last.empty()) {
      const double rate = number(values, "encoders rate_hz");
      const double since = static_cast<double>(report.unix_ms - last_ms) / 1e3;
      seconds += since;
      samples += rate * since;
      touches += number(values, "trigger glitches") - number(last, "trigger glitches");
      slowest = std::min(slowest, rate);
    }
    last = values;
    last_ms = report.unix_ms;
  }
};

class Endurance : public InTheMachine {
 protected:
  /// Adds up what the service tells within `length`.
  static Arrived listen_for(Nanoseconds length, BusCell& cell) {
    Arrived arrived;
    const Nanoseconds end = monotonic_now() + length;
    while (monotonic_now() < end && cell.service_lives()) {
      Wakeup().wait(kSecond);
      cell.listen();
      for (const HealthReport& report : cell.health) arrived.add(report);
      cell.health.clear();
    }
    return arrived;
  }
};

/// Whether the last whole second was one at full rate.
bool at_full_rate(const Cell& cell) {
  return !cell.health.empty() && number(values_of(cell.health.back()), "encoders rate_hz") > 950;
}

TEST_F(Endurance, DropsNothing) {
  const int minutes = repetitions("SELFCAL_MINUTES", 1);
  CellOptions options = small_session();
  options.id = "lasting";
  BusCell cell(options, wires, wires);
  SpinningArmOptions pace;
  pace.touch_every = 40 * kMillisecond;
  pace.closed_for = kMillisecond / 2;
  const SpinningArm arm(wires, pace);
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return at_full_rate(cell); }));
  cell.health.clear();
  const Nanoseconds began = monotonic_now();
  const double used = cpu_seconds(cell.service_pid());
  const Arrived arrived = listen_for(minutes * 60 * kSecond, cell);
  ASSERT_TRUE(cell.service_lives()) << cell.log();
  const double share = (cpu_seconds(cell.service_pid()) - used) / seconds(monotonic_now() - began);
  for (const auto& [key, value] : arrived.last)
    if (key.find("store") == std::string::npos && key.find("calibration") == std::string::npos)
      std::printf("%s: %s\n", key.c_str(), value.c_str());
  std::printf(
      "%d min: %.0f samples and %.0f touches in %.1f s, %.1f samples in the slowest second; the "
      "service used %.1f %% of the emulated processor (500 million instructions a second)\n",
      minutes, arrived.samples, arrived.touches, arrived.seconds, arrived.slowest, 100 * share);
  EXPECT_EQ(number(arrived.last, "encoders dropped"), 0);
  EXPECT_EQ(number(arrived.last, "trigger dropped"), 0);
  // All but the last seconds were told of.
  EXPECT_GT(arrived.seconds, minutes * 60 - 3);
  // Rates have four digits; a second ends when the service looks, a few samples early or late.
  const double samples = 1000 * arrived.seconds, touches = 25 * arrived.seconds;
  // The arm may be late with a cycle's last frames, so that they cannot be told from the next
  // one's: what is missing beyond the rounding must have been told.
  EXPECT_LT(arrived.samples, 1.001 * samples);
  EXPECT_GT(arrived.samples, 0.999 * samples - number(arrived.last, "encoders met_late"));
  EXPECT_GT(arrived.slowest, 950);
  // The first and the last; and the robot, late for an opening, may have made a longer closing.
  EXPECT_NEAR(arrived.touches, touches, 3 + 5e-3 * touches);
}

}  // namespace
}  // namespace selfcal
