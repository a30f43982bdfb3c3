// A robot with non-geometric effects: the same machine with the effects' parameters after its own.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/effect.h"
#include "kinematics/robot.h"

namespace selfcal {

/// `robot` with the effects that `entries` describe ({effect: joint_compliance, at: j2, c: 2e-6}),
/// measured at `context`. Their parameters are called PLACE.NAME ("j2.c"), are not free unless
/// asked for, and are held to nothing but ten times their usual size; of a second one at the place
/// with the same ones they are PLACE.NAME_2. Effects that `robot` has already are replaced. Null
/// after a problem.
std::unique_ptr<Robot> correct(std::shared_ptr<const Robot> robot, const std::vector<Node>& entries,
                               const MeasurementContext& context, Problems& problems);

/// The effects of a robot, in the order of their parameters; empty for geometry alone.
std::vector<const Effect*> effects_of(const Robot& robot);

/// The same as entries of a robot file, with the values that the robot has.
std::vector<Node> effect_entries(const Robot& robot);

/// The geometry alone: the robot itself when it has no effects.
std::shared_ptr<const Robot> geometry_of(std::shared_ptr<const Robot> robot);

}  // namespace selfcal
