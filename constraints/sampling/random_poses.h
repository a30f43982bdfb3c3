// Poses all over what a robot can do.
#pragma once

#include "constraints/methods/observations.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Joint readings drawn uniformly within the limits, count x joints; joints without limits range
/// over the readings of `data` (or a half turn / a metre each way without data).
Eigen::MatrixXd random_poses(const Robot& robot, const Observations* data, int count,
                             unsigned long long seed);

/// Those of the poses (a row each) that a robot with parameters `xi` can take: all of one without
/// loops.
Eigen::MatrixXd closing_poses(const Robot& robot, const Eigen::VectorXd& xi,
                              const Eigen::MatrixXd& q);

}  // namespace selfcal
