// The robot's end of the bus behind the port of a robot that is played.

#include "io/can/senders.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kLongest = 50 * kMillisecond;

}  // namespace

Result<std::unique_ptr<CanJointSender>> CanJointSender::open(const CanSettings& settings) {
  auto robot = CanRobotSide::open(settings);
  if (!robot) return tl::unexpected(robot.error());
  return std::unique_ptr<CanJointSender>(new CanJointSender(*std::move(robot), settings));
}

Result<void> CanJointSender::send(Nanoseconds, const std::vector<double>& q) {
  return robot_->publish_joints(q);
}

Result<std::optional<Nanoseconds>> CanJointSender::mark(Nanoseconds longest) {
  // Its own SYNC comes back at once.
  return robot_->sync(sends_sync_ ? kLongest : longest);
}

}  // namespace selfcal
