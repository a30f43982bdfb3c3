// A touch on a GPIO line of this computer as the service's trigger.
#pragma once

#include <memory>
#include <vector>

#include "io/transport.h"
#include "io/wall_clock.h"

namespace selfcal {

/// The edges of a line, which the kernel stamps, become the levels that a trigger of kind dds
/// hears, their stamps on this computer's wall clock: the one that joint states must be stamped by,
/// too.
class LineRelay {
 public:
  /// `read` gives the clocks.
  LineRelay(std::unique_ptr<TouchTrigger> line, std::unique_ptr<TriggerSender> trigger,
            ClockReading (*read)(int tries) = read_clocks)
      : line_(std::move(line)), trigger_(std::move(trigger)), read_(read) {}

  /// Passes on what has come, and repeats the level ten times a second for as long as the line can
  /// be read. An edge that was lost, whose moment nobody knows, is passed on too, so that motion
  /// stops; then it fails, for no touch may be measured by it.
  Result<void> turn(Nanoseconds now);

 private:
  std::unique_ptr<TouchTrigger> line_;
  std::unique_ptr<TriggerSender> trigger_;
  ClockReading (*read_)(int tries);
  std::vector<Edge> edges_;
  Nanoseconds changed_ = 0, repeated_ = 0;  ///< on the wall clock, on ours
};

}  // namespace selfcal
