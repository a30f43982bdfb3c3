// A session of a cell whose robot is reached by a trajectory controller of ROS 2.
#pragma once

#include <string>

#include "tests/support/cell.h"

namespace selfcal {

/// Runs `selfcal bridge` to the controller's action and the topic `touch`, and a session over it,
/// which improves the robot by 60 touches and more. Returns how many were taken.
std::size_t calibrate_through_bridge(Cell& cell, const std::string& action);

}  // namespace selfcal
