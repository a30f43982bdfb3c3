// Sends SYNC at a steady period.

#include "io/can/sync_sender.h"

#include <time.h>

#include "io/clock.h"

namespace selfcal {

Result<std::unique_ptr<SyncSender>> SyncSender::open(const std::string& interface, const CanId& id,
                                                     double period) {
  auto sender = CanSender::open(interface, false);
  if (!sender) return tl::unexpected(sender.error());
  return std::unique_ptr<SyncSender>(new SyncSender(*std::move(sender), interface, id, period));
}

SyncSender::SyncSender(CanSender sender, std::string interface, const CanId& id, double period)
    : sender_(std::move(sender)),
      interface_(std::move(interface)),
      id_(id),
      period_(nanoseconds(period)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SyncSender::run(const std::stop_token& stop) {
  CanFrame frame;
  frame.id = id_;
  Nanoseconds next = monotonic_now(), reopen = next;
  while (!stop.stop_requested()) {
    // What cannot be sent is missed by the receiver, which tells of it; an interface that was taken
    // away and came back needs another socket.
    if (!sender_.send(frame) && monotonic_now() > reopen) {
      reopen = monotonic_now() + kSecond / 2;
      if (auto sender = CanSender::open(interface_, false)) sender_ = *std::move(sender);
    }
    next = std::max(next + period_, monotonic_now());
    const timespec until{.tv_sec = next / kSecond, .tv_nsec = next % kSecond};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
}

}  // namespace selfcal
