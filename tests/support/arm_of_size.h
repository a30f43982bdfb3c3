// One arm and one delta in any size, for what must not depend on it.
#pragma once

#include <memory>

#include "kinematics/robot.h"

namespace selfcal {

/// A six-axis arm whose lengths and their tolerances are `scale` times those of a robot of 1 m.
std::unique_ptr<Robot> arm_of_size(double scale);

/// A linear delta of three towers whose lengths, limits and tolerances are `scale` times those of a
/// printer.
std::unique_ptr<Robot> delta_of_size(double scale);

}  // namespace selfcal
