// Random configurations that satisfy a method, for structural questions and for simulation.
//
// A touch or a shared location holds only at certain configurations: from random starts within the
// joint limits, Newton steps of least length bring the method's residual to its wanted value.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"
#include "constraints/progress.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Part of the space where touches may lie.
struct Patch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;  ///< m; 0 for everywhere
  bool contains(const Eigen::Vector3d& p) const {
    return radius <= 0 || (p - centre).norm() <= radius;
  }
};

/// Rows wanted for one set.
struct SampleRequest {
  int set = 0, rows = 0;
  int rows_per_group = 4;                   ///< of methods with group unknowns
  std::optional<Eigen::VectorXd> nuisance;  ///< true own values; random when missing
  Patch patch;
  std::vector<int> held;         ///< joints locked at readings of their own, one for all rows
  std::vector<Location> places;  ///< true locations of the first groups; random when missing
  /// Rows (of a group, where there are groups) may come from starts that were solved together:
  /// faster, and as random.
  bool together = false;
  int tries = 60;  ///< blocks of starts before a row is given up
  /// Residual that row `i` of the request shall have (noise of a touch); zeros when empty.
  std::function<Eigen::VectorXd(int i)> residual;
};

struct Sampled {
  State truth;            ///< true own and group values
  std::string unreached;  ///< why rows are missing; empty when all were found
};

/// Makes the rows of `data`, whose sets are given, anew: those of every request, for a robot with
/// parameters `xi`: readings, groups "g0", "g1"… and, for instruments, perfect readings. Rows of
/// requests with fewer reachable configurations are missing and `unreached` says so. Tells its
/// progress, where it can be given up.
Sampled sample_rows(const Robot& robot, const Eigen::VectorXd& xi,
                    const std::vector<SampleRequest>& requests, Random& random, DataSet& data,
                    const Progress& progress = {});

/// Writes into `rows` of `data`, which a robot can take, what perfect instruments read there; rows
/// that a paired method compares come after one another. Columns that it lacks are added.
void measure_rows(const Robot& robot, const State& truth, const std::vector<int>& rows,
                  DataSet& data);

}  // namespace selfcal
