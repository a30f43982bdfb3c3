// A robot's side of the bus: writes what its encoders read. For a simulated robot in its own
// process, and for tests.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "io/can/settings.h"
#include "io/can/socket.h"
#include "io/wall_clock.h"

namespace selfcal {

class CanRobotSide {
 public:
  /// The same settings as the service's. Where they let the service send SYNC, this side does not.
  static Result<std::unique_ptr<CanRobotSide>> open(const CanSettings& settings);

  /// For a map with SYNC: sends it, or waits for the service's, and gives the kernel's stamp of it
  /// on the time base, which is when the joints' positions are to be taken; nothing when none is
  /// seen within `longest`.
  Result<std::optional<Nanoseconds>> sync(Nanoseconds longest);
  /// Writes one frame of each message; `counts` by joint.
  Result<void> publish_counts(const std::vector<std::int64_t>& counts);
  /// The same of readings `q` (rad or m).
  Result<void> publish_joints(const std::vector<double>& q);

 private:
  CanRobotSide(const CanSettings& settings, CanSender sender, std::optional<CanReceiver> receiver);

  CanSettings settings_;
  CanSender sender_;
  std::optional<CanReceiver> receiver_;  ///< of SYNC
  WallClock clock_;
};

}  // namespace selfcal
