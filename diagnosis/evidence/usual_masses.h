// Masses for a robot whose file is silent: the physics of its loads is better known than not at
// all.
#pragma once

#include <memory>

#include "kinematics/robot.h"

namespace selfcal {

/// `robot` with the mass of the class of its size where it has statics and gravity and its file
/// gives no mass at all; otherwise the same. Its parameters stay as they are.
std::shared_ptr<const Robot> with_mass_of_its_size(std::shared_ptr<const Robot> robot);

}  // namespace selfcal
