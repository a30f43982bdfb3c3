// What a robot carries and how warm it is where it is commanded. Only its effects ask.
#pragma once

#include <limits>

#include "kinematics/robot.h"
#include "kinematics/statics.h"

namespace selfcal {

struct OperatingPoint {
  double mass = 0;  ///< kg, that the tool carries beyond the robot's own masses
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();               ///< m, of it, in the tool's frame
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< C; NaN: not known
  /// s, on the clock of the effects' moments: by default after all that have happened.
  double time = 1e15;
};

/// The conditions of so many lanes, in which `robot` turns the tool as `R(lane)` says; without rows
/// of load or temperature where these are not known.
template <class TurnOf>
MeasurementConditions conditions_at(const OperatingPoint& at, const Robot& robot, int lanes,
                                    const TurnOf& R) {
  MeasurementConditions conditions;
  conditions.time = Eigen::VectorXd::Constant(lanes, at.time);
  if (at.temperature == at.temperature)
    conditions.temperature = Eigen::VectorXd::Constant(lanes, at.temperature);
  if (at.mass == 0) return conditions;
  const Eigen::Vector3d weight = at.mass * gravity_of(robot);
  conditions.wrench.resize(lanes, 6);
  for (int lane = 0; lane < lanes; ++lane) {
    const Eigen::Vector3d force = R(lane).transpose() * weight;
    conditions.wrench.row(lane) << force.transpose(), at.centre.cross(force).transpose();
  }
  return conditions;
}

/// The endpoint at readings `q` as the robot stands there, at which its loops must close.
Location locate_at(const OperatingPoint& at, const Robot& robot, const Eigen::VectorXd& xi,
                   const Eigen::VectorXd& q);

}  // namespace selfcal
