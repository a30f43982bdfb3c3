// The robot's end of the bus behind the port of a robot that is played.
#pragma once

#include <memory>
#include <vector>

#include "io/can/robot_side.h"
#include "io/transport.h"

namespace selfcal {

class CanJointSender final : public JointSender {
 public:
  static Result<std::unique_ptr<CanJointSender>> open(const CanSettings& settings);

  /// The joints' frames.
  Result<void> send(Nanoseconds stamp, const std::vector<double>& q) override;
  bool marks() const override { return sync_; }
  /// Sends SYNC, or waits for the service's.
  Result<std::optional<Nanoseconds>> mark(Nanoseconds longest) override;

 private:
  CanJointSender(std::unique_ptr<CanRobotSide> robot, const CanSettings& settings)
      : robot_(std::move(robot)),
        sync_(settings.map.sync.has_value()),
        sends_sync_(settings.sync_send_period == 0) {}

  std::unique_ptr<CanRobotSide> robot_;
  bool sync_, sends_sync_;
};

}  // namespace selfcal
