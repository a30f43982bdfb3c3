// Readings that bring the endpoint to a pose: Levenberg and Marquardt's steps on
//   e = (p_wanted - p, w log(R_wanted R^T)),   dq = (J^T J + lambda I)^-1 J^T e,
// J = dX/dq of the robot as it is, effects included; lambda falls where a step helps and rises
// where it does not, so that steps stay short near singular places.
#pragma once

#include <limits>
#include <vector>

#include "kinematics/inverse/operating_point.h"
#include "kinematics/robot.h"

namespace selfcal {

struct ReachedPose {
  Eigen::VectorXd q;  ///< readings (rad or m)
  /// What is left (m, rad).
  double error = std::numeric_limits<double>::infinity(),
         error_angle = std::numeric_limits<double>::infinity();
  int steps = 0;
  bool there = false;  ///< to rounding; of a robot of fewer than six joints in position alone
};

/// From each row of `starts` (at most kLanes x joints, where the robot's loops should close), in
/// their order. With fewer than six joints the position comes first, then the orientation as far as
/// it goes. Limits are not looked at.
std::vector<ReachedPose> reach_pose(const Robot& robot, const Eigen::VectorXd& xi,
                                    const Location& wanted, const Eigen::MatrixXd& starts,
                                    const OperatingPoint& at = {});

}  // namespace selfcal
