#include "tests/can/interface.h"

#include <fcntl.h>
#include <linux/can.h>
#include <net/if.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "io/clock.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kPatience = 20 * kSecond;

ifreq request_for(const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  return request;
}

bool ask(unsigned long what, ifreq& request) {
  const Descriptor any(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return ::ioctl(any.handle(), what, &request) == 0;
}

}  // namespace

void CanInterfaceTest::SetUp() {
  const char* name = std::getenv("SELFCAL_CAN_INTERFACE");
  interface_ = name ? name : "vcan0";
  const char* robot = std::getenv("SELFCAL_CAN_ROBOT");
  robot_interface_ = robot ? robot : interface_;
  const Descriptor can(::socket(PF_CAN, SOCK_RAW, CAN_RAW));
  if (!can.open()) GTEST_SKIP() << "this kernel has no CAN sockets";
  if (::if_nametoindex(interface_.c_str()) == 0)
    GTEST_SKIP() << "no CAN interface " << interface_ << " (ip link add " << interface_
                 << " type vcan; ip link set " << interface_ << " up)";
  turn_ =
      Descriptor(::open((std::filesystem::path(testing::TempDir()) / "selfcal.can.turn").c_str(),
                        O_CREAT | O_RDWR | O_CLOEXEC, 0666));
  ASSERT_EQ(::flock(turn_.handle(), LOCK_EX), 0);
  mtu_ = mtu();
}

void CanInterfaceTest::TearDown() {
  if (mtu_ == 0) return;
  if (mtu() != mtu_) {
    set_up(false);
    set_mtu(mtu_);
  }
  ifreq request = request_for(interface_);
  if (ask(SIOCGIFFLAGS, request) && (request.ifr_flags & IFF_UP) == 0) set_up(true);
}

bool CanInterfaceTest::is_virtual() const {
  return !std::filesystem::exists("/sys/class/net/" + interface_ + "/device");
}

bool CanInterfaceTest::set_up(bool up) const {
  ifreq request = request_for(interface_);
  if (!ask(SIOCGIFFLAGS, request)) return false;
  request.ifr_flags =
      static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
  return ask(SIOCSIFFLAGS, request);
}

bool CanInterfaceTest::set_mtu(int mtu) const {
  ifreq request = request_for(interface_);
  request.ifr_mtu = mtu;
  return ask(SIOCSIFMTU, request);
}

int CanInterfaceTest::mtu() const {
  ifreq request = request_for(interface_);
  return ask(SIOCGIFMTU, request) ? request.ifr_mtu : 0;
}

std::uint64_t CanInterfaceTest::sent() const {
  std::uint64_t count = 0;
  std::ifstream("/sys/class/net/" + interface_ + "/statistics/tx_packets") >> count;
  return count;
}

CanSettings CanInterfaceTest::settings() const {
  CanSettings settings;
  settings.interface = interface_;
  settings.map.sync = CanId{.value = 0x80, .extended = false};
  settings.timing.window = 0.1;
  for (const std::uint32_t node : {1u, 2u}) {
    CanJoint joint;
    joint.name = "j" + std::to_string(node);
    joint.id.value = 0x180 + node;
    joint.field = byte_field(0, 4, false, true);
    joint.scale.step = 1e-6;
    settings.map.joints.push_back(joint);
  }
  EXPECT_EQ(settings.map.finish(), std::nullopt);
  return settings;
}

bool eventually(const std::function<bool()>& holds) {
  const Nanoseconds until = monotonic_now() + kPatience;
  while (!holds()) {
    if (monotonic_now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

void settle(CanReceiver& receiver, CanSender& sender, const CanId& id) {
  std::vector<CanFrame> frames;
  CanFrame frame;
  frame.id = id;
  frame.size = 4;
  EXPECT_TRUE(eventually([&] {
    ++frame.data[1];
    EXPECT_TRUE(sender.send(frame));
    pollfd waiting{.fd = receiver.handle(), .events = POLLIN, .revents = 0};
    ::poll(&waiting, 1, 100);
    EXPECT_TRUE(receiver.read(frames));
    return !frames.empty() && frames.back().data[1] == frame.data[1];
  }));
}

std::vector<CanFrame> read_frames(CanReceiver& receiver, std::size_t count) {
  std::vector<CanFrame> frames;
  const Nanoseconds until = monotonic_now() + kPatience;
  while (frames.size() < count && monotonic_now() < until) {
    pollfd waiting{.fd = receiver.handle(), .events = POLLIN, .revents = 0};
    ::poll(&waiting, 1, 100);
    const auto read = receiver.read(frames);
    EXPECT_TRUE(read) << (read ? "" : read.error().what);
  }
  return frames;
}

}  // namespace selfcal
