// Disk, network, memory and supervisor fail under the service: the state that it reaches, what it
// tells, and that it goes on from there with everything that it had collected. The table of all
// faults is in tests/faults/README.md.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <set>

#include "io/clock.h"
#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

/// A session of a robot in a process of its own, over which something fails.
class ServiceFault : public testing::Test {
 protected:
  static CellOptions options() {
    CellOptions options;
    options.live = true;
    options.touches = 12;
    options.config = "limits: {approach: 3, touch: 3, retract: 3}\n";
    return options;
  }

  void TearDown() override {
    for (const char* name :
         {"BAD_DISK", "BAD_DISK_FOLDER", "BAD_NETWORK", "NOTIFY_SOCKET", "WATCHDOG_USEC"})
      unsetenv(name);
  }

  /// Until some touches are made, with a library loaded before the service.
  void begin(const std::string& preload = {}) {
    cell.start_robot();
    cell.start_service(preload);
    ASSERT_TRUE(cell.start_session());
    ASSERT_TRUE(cell.until([&] { return cell.touches() >= 5; }));
  }

  void expect_fault(const std::string& why) {
    ASSERT_TRUE(cell.until([&] { return cell.in_state("fault"); }));
    EXPECT_NE(cell.statuses.back().why.find(why), std::string::npos) << cell.statuses.back().why;
    note_what_is_kept();
  }

  /// The session goes on when a person says so, and ends as if nothing had been.
  void expect_to_go_on() {
    ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
    EXPECT_TRUE(cell.results.empty());
    const CommandReplyMessage reply = cell.command("start");
    ASSERT_TRUE(reply.accepted) << reply.why;
    expect_the_result();
  }
  void expect_the_result() {
    ASSERT_TRUE(cell.until([&] { return !cell.results.empty(); }));
    EXPECT_EQ(cell.results.back().session, 1) << "the same session";
    EXPECT_EQ(cell.results.back().answer, "improved") << cell.results.back().why;
    EXPECT_EQ(cell.results.back().decision, "applied");
    ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
    EXPECT_EQ(must(cell.store()->sessions(10)).size(), 1u);
    EXPECT_EQ(must(cell.store()->slot(Slot::active))->session, 1);
    EXPECT_TRUE(must(cell.store()->damage()).empty());
    EXPECT_TRUE(std::ranges::includes(steps_taken(), kept_steps)) << "a touch is lost";
  }

  void note_what_is_kept() {
    kept_steps = steps_taken();
    EXPECT_GE(touches_kept(), cell.touches()) << "a touch that was told of is gone";
  }
  std::set<int> steps_taken() const {
    std::set<int> steps;
    for (const TouchRecord& touch : must(cell.store()->touches(1)))
      if (touch.outcome == TouchOutcome::taken) steps.insert(touch.step);
    return steps;
  }
  std::size_t touches_kept() const { return must(cell.store()->touches(1)).size(); }
  std::string active_file() const { return text_of(cell.folder / "state/active.robot.yaml"); }

  /// The disk under the state's folder is so from now on; "" is well.
  void disk(const std::string& how) const {
    if (how.empty())
      std::filesystem::remove(cell.folder / "disk");
    else
      std::ofstream(cell.folder / "disk") << how;
  }
  void begin_on_a_bad_disk() {
    setenv("BAD_DISK", (cell.folder / "disk").c_str(), 1);
    setenv("BAD_DISK_FOLDER", (cell.folder / "state").c_str(), 1);
    begin(SELFCAL_BAD_DISK);
  }
  /// It fails under a session, and is well again.
  void expect_to_survive_a_disk(const std::string& how) {
    begin_on_a_bad_disk();
    const std::string active = active_file();
    disk(how);
    expect_fault("store: ");
    EXPECT_EQ(active_file(), active);
    disk("");
    expect_to_go_on();
    EXPECT_NE(active_file(), active);
  }

  Cell cell{options()};
  std::set<int> kept_steps;  ///< of the plan, when it failed
};

TEST_F(ServiceFault, AFullDiskStopsTheRobotAndLosesNoTouch) { expect_to_survive_a_disk("full"); }

TEST_F(ServiceFault, AReadOnlyDiskStopsTheRobotAndLosesNoTouch) {
  expect_to_survive_a_disk("read-only");
}

TEST_F(ServiceFault, ASlowDiskOnlyTakesLonger) {
  begin_on_a_bad_disk();
  disk("slow");
  expect_the_result();
}

TEST_F(ServiceFault, AServiceDoesNotBeginWhereNothingCanBeWritten) {
  std::filesystem::create_directory(cell.folder / "state");
  setenv("BAD_DISK", (cell.folder / "disk").c_str(), 1);
  setenv("BAD_DISK_FOLDER", (cell.folder / "state").c_str(), 1);
  for (const char* how : {"full", "read-only"}) {
    disk(how);
    cell.start_service(SELFCAL_BAD_DISK);
    EXPECT_EQ(cell.wait_for_service(), kDeviceFailed) << how << "\n" << cell.log();
  }
  EXPECT_NE(cell.log().find("state"), std::string::npos) << cell.log();
}

TEST_F(ServiceFault, ANetworkThatIsGoneAndComesBackLosesNothing) {
  const std::filesystem::path gone = cell.folder / "gone";
  setenv("BAD_NETWORK", gone.c_str(), 1);
  begin(SELFCAL_BAD_NETWORK);
  const std::size_t before = cell.touches();
  std::ofstream(gone) << "";
  // Nobody hears it now: its log tells. The robot, which hears no service any more, stops too.
  ASSERT_TRUE(cell.until(
      [&] { return cell.log().find("fault: no encoder reading") != std::string::npos; }));
  EXPECT_GE(touches_kept(), before);
  // Longer than it takes to miss a peer, so that all of them find each other anew.
  const Nanoseconds missed = monotonic_now() + 3 * kSecond;
  ASSERT_TRUE(cell.until([&] { return monotonic_now() > missed; }));
  std::filesystem::remove(gone);
  cell.statuses.clear();
  expect_to_go_on();
}

TEST_F(ServiceFault, AMotionThatNeverArrivesIsGivenUp) {
  // The robot stands, is heard, and takes no request.
  const auto path = cell.folder / "rx90_cell.scenario.yaml";
  const std::string well = text_of(path);
  std::string ill = well;
  replace(ill, "\nmachine: {", "\nmachine: {faults: [{what: silent}], ");
  std::ofstream(path) << ill;
  cell.start_robot();
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  expect_fault("took longer than 3 s");
  cell.kill_robot();
  std::ofstream(path) << well;
  cell.start_robot();
  expect_to_go_on();
}

/// systemd's end of the notifications.
class Notified {
 public:
  explicit Notified(const std::filesystem::path& path)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Notified() { ::close(socket_); }
  /// How often `what` came since the last call.
  int take(const std::string& what) {
    int count = 0;
    std::array<char, 512> text{};
    for (ssize_t got = 0; (got = ::recv(socket_, text.data(), text.size(), 0)) >= 0;)
      count += std::string(text.data(), static_cast<std::size_t>(got)) == what;
    return count;
  }

 private:
  int socket_;
};

TEST_F(ServiceFault, AFrozenServiceIsMissedByItsWatchdogAndGoesOnAfterARestart) {
  const std::string path = "/tmp/selfcal_notify_" + std::to_string(getpid());
  std::filesystem::remove(path);
  Notified systemd(path);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  setenv("WATCHDOG_USEC", "1000000", 1);
  begin();
  ASSERT_TRUE(cell.until([&] { return systemd.take("WATCHDOG=1") > 0; }));
  ::kill(cell.service_pid(), SIGSTOP);
  systemd.take("");
  const Nanoseconds missed = monotonic_now() + 2 * kSecond;
  ASSERT_TRUE(cell.until([&] { return monotonic_now() > missed; }));
  EXPECT_EQ(systemd.take("WATCHDOG=1"), 0) << "two of its periods";
  note_what_is_kept();
  // What systemd does then.
  cell.kill_service();
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return systemd.take("READY=1") > 0; }));
  expect_the_result();
  std::filesystem::remove(path);
}

/// Leaves a process so much memory beyond what it has mapped; nothing takes the limit away.
void leave_memory(pid_t process, std::optional<std::size_t> bytes) {
  rlimit limit{};
  ASSERT_EQ(prlimit(process, RLIMIT_AS, nullptr, &limit), 0);
  limit.rlim_cur = limit.rlim_max;
  if (bytes) {
    std::ifstream pages("/proc/" + std::to_string(process) + "/statm");
    std::size_t mapped = 0;
    pages >> mapped;
    limit.rlim_cur = mapped * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + *bytes;
  }
  ASSERT_EQ(prlimit(process, RLIMIT_AS, &limit, nullptr), 0);
}

TEST_F(ServiceFault, WithoutMemoryItStopsOrEndsAndGoesOnWhenThereIsSome) {
  begin();
  leave_memory(cell.service_pid(), 0);
  // Out of memory it ends, is killed, or says so in a fault; or what it has is enough.
  cell.until(
      [&] { return !cell.service_lives() || cell.in_state("fault") || !cell.results.empty(); });
  note_what_is_kept();
  const bool lives = cell.service_lives();
  std::printf("with no more memory: %s\n", !lives                 ? "it ended"
                                           : cell.results.empty() ? "a fault"
                                                                  : "what it had was enough");
  if (lives) {
    leave_memory(cell.service_pid(), std::nullopt);
    if (cell.results.empty()) return expect_to_go_on();
    return expect_the_result();
  }
  cell.kill_service();
  cell.start_service();
  expect_the_result();
}

/// What looks like RTPS and is not: headers and submessages of the protocol with bytes changed,
/// lengths that lie, pieces of messages that end too early.
class MalformedRtps {
 public:
  std::string next() {
    std::string packet = "RTPS";
    packet += {2, 1, 1, 16};
    for (int i = 0; i < 12; ++i) packet += byte();  // who sends it
    const int submessages = static_cast<int>(random_() % 4);
    for (int i = 0; i <= submessages; ++i) add_submessage(packet);
    for (auto changes = random_() % 3; changes > 0; --changes)
      packet[random_() % packet.size()] = byte();
    if (random_() % 8 == 0) packet.resize(random_() % packet.size());
    return packet;
  }

 private:
  char byte() { return static_cast<char>(random_() % 256); }
  void add_submessage(std::string& packet) {
    // ACKNACK, HEARTBEAT, GAP, INFO_TS, INFO_DST, DATA, DATA_FRAG, ..., and those of DDS Security.
    constexpr std::array<unsigned char, 14> kKinds = {0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e,
                                                      0x0f, 0x12, 0x13, 0x15, 0x16, 0x30, 0x31};
    const std::size_t length = random_() % 200;
    const std::size_t said = random_() % 4 == 0 ? random_() % 65536 : length;
    packet += static_cast<char>(kKinds[random_() % kKinds.size()]);
    packet += byte();
    packet += static_cast<char>(said % 256);
    packet += static_cast<char>(said / 256);
    for (std::size_t i = 0; i < length; ++i) packet += random_() % 3 == 0 ? byte() : '\0';
  }
  std::mt19937_64 random_{5};
};

TEST_F(ServiceFault, AFloodOfMalformedRtpsChangesNothing) {
  begin();
  MalformedRtps packets;
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int sent = 0;
  ASSERT_TRUE(cell.until([&] {
    for (int i = 0; i < 500; ++i) {
      const std::string packet = packets.next();
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      // Discovery and data of the first four participants: RTPS 2.3, 9.6.1.1.
      to.sin_port = htons(static_cast<std::uint16_t>(7410 + 250 * cell.domain + i % 8));
      sent += ::sendto(socket, packet.data(), packet.size(), 0,
                       reinterpret_cast<const sockaddr*>(&to), sizeof to) > 0;
    }
    return !cell.results.empty() || !cell.service_lives() || cell.in_state("fault");
  }));
  ::close(socket);
  EXPECT_TRUE(cell.service_lives());
  std::printf("%d malformed packets\n", sent);
  EXPECT_LT(std::filesystem::file_size(cell.folder / "service.log"), 100'000)
      << "it was not flooded";
  expect_the_result();
}

}  // namespace
}  // namespace selfcal
