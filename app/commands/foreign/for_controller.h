// A calibrated robot for a controller that takes less than all of it: joint offsets with base and
// tool frame, a table of Denavit and Hartenberg's numbers, the kinematics of a Universal Robots
// arm, a printer's lines. What is written is fitted, so that these numbers alone bring the
// controller's model nearest to the calibrated robot, and says how near that is.
#pragma once

#include <string>

#include "io/result.h"

namespace selfcal {

struct ControllerFormat {
  std::string to;          ///< "offsets", "dh", "ur" or "delta"
  std::string file;        ///< the robot's
  std::string like;        ///< of "ur": the kinematics file that the driver has
  std::string convention;  ///< of "dh": "standard" or "modified"
};

/// The text of the robot file `robot` for the controller; what it does not hold is noted on
/// standard error.
Result<std::string> for_controller(const Node& robot, const ControllerFormat& format);

}  // namespace selfcal
