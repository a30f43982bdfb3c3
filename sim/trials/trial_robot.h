// The arm of a trial: what its maker says of it and what it really is.
#pragma once

#include <memory>
#include <vector>

#include "constraints/methods/method.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A six-joint arm in the manner of a UR10, its lengths, masses and tool drawn: no trial has the
/// same.
std::unique_ptr<Robot> draw_arm(Random& random);

/// Parameters of the robot as it is built and put up: 0.3 to 1 mm and mrad off, gears 5e-5 to 1e-4,
/// base and tool a few mm and mrad.
Eigen::VectorXd draw_geometry(const Robot& robot, Random& random);

/// Masses (kg) and centres of mass (m) by link, 10 to 20 % and 10 mm off what the maker says; on
/// legs those of what they carry, of which no maker says anything.
struct Weights {
  std::vector<double> mass;
  std::vector<Eigen::Vector3d> com;
};
Weights draw_weights(const Robot& robot, Random& random);

/// N: of the loads that a session puts on the tip.
double most_load(const Robot& robot);

}  // namespace selfcal
