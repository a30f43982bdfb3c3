// Other ways into the contact of a touch: the same readings at the contact, come to with other
// joints moving, or the same ones the other way round. Play and what a joint drags behind it show
// by that.
#pragma once

#include <vector>

#include "constraints/planning/touch_plan.h"

namespace selfcal {

/// At most `count` touches of the same contact whose joints come in otherwise, each from a free
/// start within the limits of the cell, with the tip sinking towards the surface all the way. Of
/// planes alone; `target` is the touch's. None where the cell leaves none.
std::vector<PlannedTouch> other_approaches(const Robot& robot, const Eigen::VectorXd& xi,
                                           const TouchTarget& target,
                                           const std::vector<Obstacle>& obstacles,
                                           const TouchPlanOptions& options,
                                           const PlannedTouch& touch, int count, Random& random);

}  // namespace selfcal
