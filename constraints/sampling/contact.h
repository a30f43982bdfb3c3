// Where a machine stops that meets a surface or a socket a little off.
#pragma once

#include <Eigen/Dense>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Moves readings `q`, which satisfy the method of `row` exactly, by the least change to where its
/// residual is `wanted` (one entry for each equation; m, rad). A paired method's is counted against
/// `q` itself, so that each row has its own error and shares none. The joints `held` stay. False,
/// with `q` as it was, when no such place was found.
bool move_to_residual(const Robot& robot, const DataSet& data, const State& truth, int row,
                      const Eigen::VectorXd& wanted, Eigen::VectorXd& q,
                      const std::vector<int>& held = {});

}  // namespace selfcal
