#include "kinematics/inverse/operating_point.h"

#include "kinematics/expects.h"

namespace selfcal {

Location locate_at(const OperatingPoint& at, const Robot& robot, const Eigen::VectorXd& xi,
                   const Eigen::VectorXd& q) {
  const Location geometry = locate(robot, xi, q);
  ConfigurationBlock block = block_of(q);
  block.conditions = conditions_at(at, robot, block.lanes(), [&](int) { return geometry.R; });
  Locations X;
  expects(robot.locate(block, xi, Body::endpoint, X, nullptr).closes(0), "the loops close");
  return X.at(0);
}

}  // namespace selfcal
