// Random configurations that satisfy the methods of a plan, and where everything lies.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/planning/plan_equations.h"
#include "constraints/progress.h"

namespace selfcal {

struct PoolRequest {
  /// What is measured: sets with their methods, none that refers to another. Where a surface or
  /// socket lies that is not given is drawn.
  std::vector<Set> sets;
  int candidates = 1000;  ///< drawn, over all sets
  int groups = 2;         ///< sockets or nests, of each method that has such; from 1
  /// Configurations measured already, of the same sets (set, group and q are looked at); they lie
  /// on the surfaces that are planned for. Without rows: none.
  DataSet taken = {};
  double spacing = 0;  ///< m, least between end positions of a set, those taken included
  /// Covariance of the robot's parameters before any row; without rows the makers' tolerances.
  Eigen::MatrixXd prior = {};
  std::vector<int> held = {};   ///< joints locked, in each set at a reading of its own
  unsigned long long seed = 1;  ///< of all that is drawn
};

struct Pool {
  DataSet data;
  State state;
  std::vector<Unit> units;
  std::string unreached;  ///< why some are missing; empty when all were found
};

/// By set, where the endpoint was at its rows (m, world).
using EndPositions = std::vector<std::vector<Eigen::Vector3d>>;
EndPositions end_positions(const Robot& robot, const Eigen::VectorXd& xi, const DataSet& data);
/// One of `others` is nearer to `p` than `spacing` (m).
bool nearer_than(double spacing, const Eigen::Vector3d& p,
                 const std::vector<Eigen::Vector3d>& others);

Pool draw_pool(const Robot& robot, const Eigen::VectorXd& xi, const PoolRequest& request,
               const Progress& progress = {});

}  // namespace selfcal
