#include "app/bridge/line_relay.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kRepeatLine = kSecond / 10;
constexpr int kClockTries = 5;

}  // namespace

Result<void> LineRelay::turn(Nanoseconds now) {
  edges_.clear();
  if (auto taken = line_->take(edges_); !taken) return taken;
  const ClockReading clocks = read_(kClockTries);
  const Nanoseconds to_wall = clocks.wall - (clocks.before + clocks.after) / 2;
  for (const Edge& edge : edges_) {
    changed_ = edge.time + to_wall;
    repeated_ = now;
    if (auto sent = trigger_->send(changed_, edge.closed); !sent) return sent;
    if (!edge.timed)
      return device_failed(
          "an edge of the touch's line was lost: " +
          (line_->trouble().empty() ? "its moment is not known" : line_->trouble()));
  }
  const std::optional<bool> level = line_->closed();
  if (!level || now - repeated_ < kRepeatLine) return {};
  if (changed_ == 0) changed_ = now + to_wall;
  repeated_ = now;
  return trigger_->send(changed_, *level);
}

}  // namespace selfcal
