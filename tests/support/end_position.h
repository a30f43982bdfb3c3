// Where a robot's endpoint is, and how far two sets of parameters differ there.
#pragma once

#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// The endpoint at readings q (rad or m).
Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& q);

/// Length of the end position's error (m), in ascending order, over 500 random poses after the
/// best rigid motion of the base (Kabsch), which touches of unknown planes cannot place.
std::vector<double> aligned_errors(const Robot& robot, const Eigen::VectorXd& xi,
                                   const Eigen::VectorXd& truth);

}  // namespace selfcal
