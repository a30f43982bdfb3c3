// A straight move in joint space as a trajectory that a controller follows.
#pragma once

#include <vector>

#include "io/dds/ros/trajectory_action.h"

namespace selfcal {

/// From rest at `from` to rest at `to`, all joints in step, none faster than `speed` (rad/s or m/s)
/// or harder than `acceleration` (per s^2): speeding up, an even part where there is room, slowing
/// down. Each part is a parabola or a line, which a controller that interpolates by cubics between
/// positions and velocities follows exactly. One point, at once, where there is no way to go.
std::vector<TrajectoryPoint> approach(const std::vector<double>& from,
                                      const std::vector<double>& to, double speed,
                                      double acceleration);

}  // namespace selfcal
