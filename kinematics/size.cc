#include "kinematics/size.h"

#include <cmath>

namespace selfcal {
namespace {

/// The middle of every joint's way.
Eigen::VectorXd middle(const Robot& robot) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = (robot.joints()[static_cast<std::size_t>(j)].lower +
            robot.joints()[static_cast<std::size_t>(j)].upper) /
           2;
  return q;
}

}  // namespace

double size_of(const Robot& robot) {
  const Eigen::VectorXd legs = robot.leg_lengths(nominal_values(robot), middle(robot));
  if (legs.size() > 0) return legs.maxCoeff();
  double reach = 0;
  for (const Parameter& p : robot.parameters())
    if (p.quantity == Quantity::length && p.part == Part::link) reach += std::abs(p.nominal);
  for (const Joint& joint : robot.joints())
    if (joint.quantity == Quantity::length) reach += joint.range();
  return reach > 0 ? reach : 1;
}

Eigen::ArrayXd units_of_readings(const Robot& robot) {
  Eigen::ArrayXd units(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < units.size(); ++j) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    units[j] = joint.quantity == Quantity::angle ? 1 : joint.range() / 2;
  }
  return units;
}

}  // namespace selfcal
