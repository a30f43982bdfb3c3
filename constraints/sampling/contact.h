// Where a machine stops that meets a surface or a socket a little off.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

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

/// The same for many rows of one set at once: row `rows[i]` from `q.row(i)` to `wanted.row(i)`.
std::vector<std::optional<Eigen::VectorXd>> moved_to_residuals(
    const Robot& robot, const DataSet& data, const State& truth, const std::vector<int>& rows,
    const Eigen::MatrixXd& wanted, const Eigen::MatrixXd& q, const std::vector<int>& held = {});

}  // namespace selfcal
