// What the service costs the robot's computer.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "io/dds/names.h"
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

/// A domain in which this process sends messages of any size, and those that it starts do not.
std::uint32_t domain_of_long_messages() {
  const std::uint32_t domain = new_domain();
  const std::string usual = std::getenv("CYCLONEDDS_URI");
  setenv("CYCLONEDDS_URI",
         (usual + ",<Internal><MaxSampleSize>100 MB</MaxSampleSize></Internal>").c_str(), 1);
  return domain;
}

TEST(Overhead, KeepsToItsMemoryUnderCommandsOfTwentyMegabytes) {
  CellOptions options;
  options.touches = 8;
  options.domain = domain_of_long_messages();
  Cell cell(options);
  const auto rude = must(DdsParticipant::open(cell.domain, "rude"));
  const std::string raised = std::getenv("CYCLONEDDS_URI");
  setenv("CYCLONEDDS_URI", raised.substr(0, raised.rfind(',')).c_str(), 1);
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  const double before = megabytes(cell.service_pid(), "VmHWM");

  std::string huge(20'000'000, 'x'), large(1'000'000, 'y');
  char verb[] = "start", nobody[] = "";
  int sent = 0;
  for (int i = 0; i < 30; ++i) {
    // Each from a writer of its own, whose history the next does not wait for.
    auto commands =
        must(DdsWriter<dds::Command>::open(rude, robot_topic("cell", "command"), kReplies));
    ASSERT_TRUE(cell.until([&] { return commands.matched() > 0; }));
    std::string id = std::to_string(i);
    sent += commands.write({.id_ = id.data(), .verb_ = huge.data(), .from_ = nobody}).has_value();
    sent += commands.write({.id_ = large.data(), .verb_ = verb, .from_ = nobody}).has_value();
    cell.listen();
  }
  EXPECT_EQ(cell.command("abort").why, "no session is running") << "others are still heard";
  const double after = megabytes(cell.service_pid(), "VmHWM");
  std::printf("%d commands of 1 and 20 MB: %.1f MB at most before, %.1f MB after\n", sent, before,
              after);
  // The unit allows 512 MB. What is on its way at the moment is kept, and no more.
  EXPECT_LT(after, before + 60);
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
