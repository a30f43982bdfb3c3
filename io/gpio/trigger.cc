// The touch trigger on a GPIO line.

#include "io/gpio/trigger.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "io/clock.h"
#include "io/urgency.h"

namespace selfcal {
namespace {

// Between two looks at the level (ms): while nothing happens, and while an edge may be missing.
constexpr int kCheck = 100, kCheckSoon = 2;
constexpr int kTryAgain = 1000;  // ms, to get a line back that has gone

}  // namespace

Result<std::unique_ptr<GpioTrigger>> GpioTrigger::open(const GpioSettings& settings,
                                                       Wakeup& wakeup) {
  const int stop = eventfd(0, EFD_CLOEXEC);
  if (stop < 0) return device_failed("no event descriptor can be had");
  std::unique_ptr<GpioTrigger> trigger(new GpioTrigger(settings, wakeup, stop));
  if (auto taken = trigger->take_line(); !taken) return tl::make_unexpected(taken.error());
  trigger->thread_ = std::thread([&self = *trigger] { self.watch(); });
  return trigger;
}

GpioTrigger::GpioTrigger(GpioSettings settings, Wakeup& wakeup, int stop)
    : settings_(std::move(settings)), wakeup_(wakeup), stop_(stop) {}

GpioTrigger::~GpioTrigger() {
  if (thread_.joinable()) {
    eventfd_write(stop_, 1);
    thread_.join();
  }
  ::close(stop_);
}

Result<void> GpioTrigger::take_line() {
  auto line = GpioLine::open(settings_);
  if (!line) return tl::make_unexpected(line.error());
  const auto level = line->closed();
  if (!level) return tl::make_unexpected(level.error());
  line_ = *std::move(line);
  const std::lock_guard lock(mutex_);
  if (watch_) lost_before_ += watch_->lost();
  watch_.emplace(*level, monotonic_now());
  gone_.clear();
  return {};
}

void GpioTrigger::watch() {
  become_urgent();  // or not: then the kernel decides
  for (;;) {
    std::array<pollfd, 2> wait = {{{stop_, POLLIN, 0}, {-1, POLLIN, 0}}};
    int longest = kTryAgain;
    if (line_) {
      wait[1].fd = line_->descriptor();
      longest = watch_->suspicious() ? kCheckSoon : kCheck;
    }
    if (poll(wait.data(), wait.size(), longest) < 0 && errno != EINTR) continue;
    if (wait[0].revents != 0) return;
    Result<void> done;
    if (!line_)
      done = take_line();
    else if ((wait[1].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0)
      done = tl::make_unexpected(line_failure(settings_, ENODEV));
    else
      done = read_once((wait[1].revents & POLLIN) != 0);
    if (done) continue;
    line_.reset();
    const std::lock_guard lock(mutex_);
    gone_ = done.error().what;
    wakeup_.notify();
  }
}

Result<void> GpioTrigger::read_once(bool readable) {
  events_.clear();
  edges_.clear();
  if (readable) {
    if (auto read = line_->read(events_); !read) return read;
    const std::lock_guard lock(mutex_);
    watch_->add(events_, monotonic_now(), edges_);
    keep(edges_);
    return {};
  }
  const auto level = line_->closed();
  if (!level) return tl::make_unexpected(level.error());
  const std::lock_guard lock(mutex_);
  watch_->check(*level, monotonic_now(), edges_);
  keep(edges_);
  return {};
}

/// With the mutex held.
void GpioTrigger::keep(const std::vector<Edge>& edges) {
  if (edges.empty()) return;
  waiting_.insert(waiting_.end(), edges.begin(), edges.end());
  for (; waiting_.size() > kMostEdges; ++overflowed_) {
    waiting_.pop_front();
    waiting_.front().timed = false;  // it may not be the first of its burst any more
  }
  wakeup_.notify();
}

std::optional<bool> GpioTrigger::closed() {
  const std::lock_guard lock(mutex_);
  if (!gone_.empty()) return std::nullopt;
  return watch_->closed(monotonic_now());
}

Result<void> GpioTrigger::take(std::vector<Edge>& out) {
  const std::lock_guard lock(mutex_);
  out.insert(out.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  return {};
}

std::uint64_t GpioTrigger::dropped() const {
  const std::lock_guard lock(mutex_);
  return lost_before_ + watch_->lost() + overflowed_;
}

std::string GpioTrigger::trouble() const {
  const std::lock_guard lock(mutex_);
  return gone_.empty() ? watch_->trouble(monotonic_now()) : gone_;
}

}  // namespace selfcal
