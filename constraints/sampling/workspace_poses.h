// Poses where the end position counts.
#pragma once

#include "constraints/workspace.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Readings within the limits, at most `count` x joints: where a box is given, those that bring the
/// endpoint of the robot with parameters `xi` to places drawn uniformly from it, with the tool
/// within the cone; else those between two of `rows` (rows x joints), drawn uniformly. Fewer, even
/// none, where the robot hardly reaches them.
Eigen::MatrixXd workspace_poses(const Robot& robot, const Eigen::VectorXd& xi,
                                const Workspace& workspace, const Eigen::MatrixXd& rows, int count,
                                unsigned long long seed);

}  // namespace selfcal
