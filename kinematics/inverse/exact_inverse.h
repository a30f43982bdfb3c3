// Inverse kinematics in closed form: all readings that bring the endpoint to a pose.
//
// Six revolute joints whose last three axes meet (a spherical wrist: Pieper): the wrist's centre is
// where the first three put it, its distance from a point of axis 1 and its height along that axis
// depend on joints 2 and 3 alone, two equations of the first degree in each; the orientation then
// gives the last three. Six revolute joints whose second to fourth axes are parallel (the offset
// wrist of light arms): along these axes nothing but joints 1 and 5 moves a point of axis 6, or
// turns its direction; what is left is planar. Parallel robots: chain by chain.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// All readings for a pose, each once. Of whole turns of a joint the one within its limits that is
/// nearest to `near`, else the nearest; where an axis may stand anywhere, as in `near`.
using ExactInverse = std::function<std::vector<Eigen::VectorXd>(const Location& wanted,
                                                                const Eigen::VectorXd& near)>;

/// Of the robot with parameters `xi`, which need not be the maker's; empty where there is no closed
/// form: other structures, joints that move each other, effects.
ExactInverse exact_inverse(std::shared_ptr<const Robot> robot, const Eigen::VectorXd& xi);

}  // namespace selfcal
