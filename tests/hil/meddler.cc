#include "tests/hil/meddler.h"

#include <fcntl.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/clock.h"

namespace selfcal {
namespace {

int open_bus(const std::string& interface) {
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  EXPECT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0)
      << interface;
  return socket;
}

Wiring own_wires(const Wiring& service) {
  EXPECT_EQ(std::system("ip link add vcan1 type vcan && ip link set vcan1 up"), 0) << "needs root";
  Wiring robot = service;
  robot.robot_interface = "vcan1";
  robot.pull = std::filesystem::path(testing::TempDir()) / "meddled_pull";
  std::ofstream(robot.pull) << "pull-down";
  return robot;
}

}  // namespace

Meddler::Meddler(const Wiring& service)
    : service_(service),
      robot_(own_wires(service)),
      from_(open_bus(robot_.robot_interface)),
      to_(open_bus(service.interface)),
      watch_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)),
      pull_(::open(service.pull.c_str(), O_WRONLY | O_CLOEXEC)) {
  EXPECT_GE(inotify_add_watch(watch_, robot_.pull.c_str(), IN_MODIFY), 0);
  EXPECT_EQ(setsockopt(to_, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0), 0);  // it only speaks
  honest();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Meddler::~Meddler() {
  thread_.request_stop();
  thread_.join();
  for (const int file : {from_, to_, watch_, pull_}) ::close(file);
  EXPECT_EQ(std::system("ip link del vcan1"), 0);
}

void Meddler::frames(FrameRule rule) {
  const std::lock_guard lock(mutex_);
  frame_rule_ = std::move(rule);
}

void Meddler::level(LevelRule rule) {
  {
    const std::lock_guard lock(mutex_);
    level_rule_ = std::move(rule);
  }
  pass_level();
}

void Meddler::honest() {
  frames([](const can_frame& frame, const PutFrame& put) { put(frame, 0); });
  level([](bool closed) { return closed; });
}

void Meddler::put(const can_frame& frame) const {
  // The interface may be down.
  [[maybe_unused]] const auto written = ::write(to_, &frame, sizeof frame);
}

void Meddler::drive(bool closed) const {
  const std::string_view text = closed ? "pull-up" : "pull-down";
  EXPECT_EQ(::pwrite(pull_, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
}

void Meddler::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> waiting = {{{from_, POLLIN, 0}, {watch_, POLLIN, 0}}};
    ::poll(waiting.data(), waiting.size(), due_.empty() ? 50 : 1);
    if ((waiting[0].revents & POLLIN) != 0) pass_frames();
    put_due();
    if ((waiting[1].revents & POLLIN) != 0) pass_level();
  }
}

void Meddler::pass_frames() {
  const std::lock_guard lock(mutex_);
  can_frame frame{};
  while (::recv(from_, &frame, sizeof frame, MSG_DONTWAIT) == sizeof frame)
    frame_rule_(frame, [this](const can_frame& each, Nanoseconds later) {
      if (later == 0) return put(each);
      due_.emplace(monotonic_now() + later, each);
    });
}

void Meddler::put_due() {
  const Nanoseconds now = monotonic_now();
  while (!due_.empty() && due_.begin()->first <= now) {
    put(due_.begin()->second);
    due_.erase(due_.begin());
  }
}

void Meddler::pass_level() {
  std::array<char, 4096> news{};
  while (::read(watch_, news.data(), news.size()) > 0) {
  }
  std::string text;
  std::ifstream(robot_.pull) >> text;
  const std::lock_guard lock(mutex_);
  closed_ = text.starts_with("pull-up");
  drive(level_rule_(closed_));
}

}  // namespace selfcal
