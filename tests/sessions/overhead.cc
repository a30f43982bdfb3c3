// What the service costs the robot's computer.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/cell.h"

namespace selfcal {
namespace {

/// A line of /proc/PID/status, in MB.
double megabytes(pid_t pid, const std::string& key) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

TEST(Overhead, StaysBelowFiveMillisecondsOfCpuATouch) {
  CellOptions options;
  options.live = true;
  options.touches = 12;
  Cell cell(options);
  cell.start_robot();
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return cell.touches() >= 6; }));
  const double own_before = cpu_seconds(cell.service_pid(), true);
  const double all_before = cpu_seconds(cell.service_pid(), false);
  const auto first = cell.touches();
  ASSERT_TRUE(cell.until([&] { return cell.touches() >= 60; }));
  const double count = static_cast<double>(cell.touches() - first);
  const double nuisance = (cpu_seconds(cell.service_pid(), true) - own_before) / count;
  const double all = (cpu_seconds(cell.service_pid(), false) - all_before) / count;
  std::printf(
      "%.2f ms of CPU a touch by the service, %.2f ms with the threads of DDS, which carry "
      "encoders at 500 Hz; %.0f MB at most\n",
      1e3 * nuisance, 1e3 * all, megabytes(cell.service_pid(), "VmHWM"));
  // Three times the bound, for sanitizers and loaded machines; the figure itself is printed.
  EXPECT_LT(nuisance, 0.015);
}

TEST(Overhead, KeepsToItsMemoryOverManySessions) {
  const int sessions = repetitions("SELFCAL_ENDURANCE", 8);
  CellOptions options;
  options.touches = 8;
  Cell cell(options);
  cell.start_service();
  double early = 0;
  for (int session = 1; session <= sessions; ++session) {
    ASSERT_TRUE(cell.start_session());
    ASSERT_TRUE(cell.until(
        [&] { return static_cast<int>(cell.results.size()) >= session && cell.in_state("idle"); }));
    if (session == (sessions + 3) / 4) early = megabytes(cell.service_pid(), "VmRSS");
  }
  const double late = megabytes(cell.service_pid(), "VmRSS");
  std::printf("%d sessions: %.1f MB after a quarter of them, %.1f MB at the end, %.1f MB at most\n",
              sessions, early, late, megabytes(cell.service_pid(), "VmHWM"));
  EXPECT_LT(megabytes(cell.service_pid(), "VmHWM"), 64);
  EXPECT_LT(late, early + 3) << "the allocator's own reserves aside, it does not grow";
}

}  // namespace
}  // namespace selfcal
