// A robot's side of the bus.

#include "io/can/robot_side.h"

#include <poll.h>

#include <algorithm>

#include "io/clock.h"

namespace selfcal {

Result<std::unique_ptr<CanRobotSide>> CanRobotSide::open(const CanSettings& settings) {
  const bool fd = std::ranges::any_of(settings.map.messages, &CanMessage::fd);
  auto sender = CanSender::open(settings.interface, fd);
  if (!sender) return tl::unexpected(sender.error());
  std::optional<CanReceiver> receiver;
  if (settings.map.sync) {
    auto opened = CanReceiver::open(
        {.interface = settings.interface, .ids = {*settings.map.sync}, .errors = false});
    if (!opened) return tl::unexpected(opened.error());
    receiver = *std::move(opened);
  }
  return std::unique_ptr<CanRobotSide>(
      new CanRobotSide(settings, *std::move(sender), std::move(receiver)));
}

CanRobotSide::CanRobotSide(const CanSettings& settings, CanSender sender,
                           std::optional<CanReceiver> receiver)
    : settings_(settings), sender_(std::move(sender)), receiver_(std::move(receiver)) {
  clock_.observe(read_clocks(), true);
}

Result<std::optional<Nanoseconds>> CanRobotSide::sync(Nanoseconds longest) {
  if (!receiver_) return bad_input("the map has no SYNC");
  std::vector<CanFrame> frames;
  // An older one would be taken for this.
  for (CanRead end = CanRead::more; end == CanRead::more;) {
    auto read = receiver_->read(frames);
    if (!read) return tl::unexpected(read.error());
    end = *read;
  }
  frames.clear();
  if (settings_.sync_send_period == 0) {
    CanFrame frame;
    frame.id = *settings_.map.sync;
    if (auto sent = sender_.send(frame); !sent) return tl::unexpected(sent.error());
  }
  const Nanoseconds until = monotonic_now() + longest;
  while (frames.empty()) {
    const Nanoseconds left = until - monotonic_now();
    if (left <= 0) return std::optional<Nanoseconds>();
    pollfd waiting{.fd = receiver_->handle(), .events = POLLIN, .revents = 0};
    ::poll(&waiting, 1, static_cast<int>(left / kMillisecond) + 1);
    if (auto read = receiver_->read(frames); !read) return tl::unexpected(read.error());
  }
  clock_.observe(read_clocks(1), true);
  return clock_.monotonic(frames.back().stamp);
}

Result<void> CanRobotSide::publish_counts(const std::vector<std::int64_t>& counts) {
  for (const CanMessage& message : settings_.map.messages)
    if (auto sent = sender_.send(encode(settings_.map, message, counts)); !sent) return sent;
  return {};
}

Result<void> CanRobotSide::publish_joints(const std::vector<double>& q) {
  std::vector<std::int64_t> counts;
  for (std::size_t j = 0; j < q.size(); ++j)
    counts.push_back(counts_of(settings_.map.joints[j].scale, q[j]));
  return publish_counts(counts);
}

}  // namespace selfcal
