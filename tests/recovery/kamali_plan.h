// Where the robot goes in the experiment of Kamali et al. and what pulls at it there.
#pragma once

#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "kinematics/robot.h"

namespace selfcal::recovery {

inline constexpr double kDegree = std::numbers::pi / 180;

inline constexpr int kWrenches = 7;  ///< at each pose

/// 125 x 6: five by five by five points in a cube of 500 mm in front of the robot, the tool
/// pointing away from it and down, give or take a radian about each axis, so that the tracker sees
/// it. Any of the inverse kinematics' solutions.
Eigen::MatrixXd poses_in_the_cube(const Robot& robot, std::mt19937_64& random);

/// count x 6. "Normally distributed in the range of -120 N to 120 N and -10 to 10 N m,
/// respectively": how widely the paper does not say. Here the range is two sigma of a component and
/// bounds the whole vector.
Eigen::MatrixXd random_wrenches(Eigen::Index count, std::mt19937_64& random);

}  // namespace selfcal::recovery
