// How large a machine is, so that thresholds of its lengths and of its readings grow with it.
#pragma once

#include <Eigen/Dense>

#include "kinematics/robot.h"

namespace selfcal {

/// How far the machine reaches by the maker's figures (m): the sum of an arm's links, the longest
/// leg of a machine that legs carry. 1 where neither is known.
double size_of(const Robot& robot);

/// By joint, the change of a reading that thresholds are multiples of: 1 rad where it turns, half
/// of its way where it slides (1 m where its file gives no limits).
Eigen::ArrayXd units_of_readings(const Robot& robot);

}  // namespace selfcal
