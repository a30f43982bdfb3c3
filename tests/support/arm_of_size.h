// One arm in any size, for what must not depend on it.
#pragma once

#include <memory>

#include "kinematics/robot.h"

namespace selfcal {

/// A six-axis arm whose lengths and their tolerances are `scale` times those of a robot of 1 m.
std::unique_ptr<Robot> arm_of_size(double scale);

}  // namespace selfcal
