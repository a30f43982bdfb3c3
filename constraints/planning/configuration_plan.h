// Which configurations to measure at, by any method or several, so that most is known afterwards.
//
// A pool of random configurations that satisfy the methods (plan_pool.h); of these as many as are
// asked for, by exchange (detmax.h); those moved until nothing near is better (refinement.h); a
// short tour (tour.h).
#pragma once

#include <string>
#include <vector>

#include "constraints/planning/plan_system.h"
#include "constraints/progress.h"

namespace selfcal {

struct PlanRequest {
  PoolRequest pool;  ///< at least `count` candidates
  int count = 30;    ///< units to be visited (plan_equations.h), at least 1
  Criterion criterion = Criterion::sigma;
  Workspace workspace = {};  ///< without a box: all that the joints can do
  double longest = 0;        ///< s, most that the way may take; 0: any time. Fewer are chosen then
  Eigen::VectorXd speed;     ///< by joint (rad/s, m/s), above 0
};

struct ConfigurationPlan {
  /// Why there is no plan; empty where there is one. The rest means nothing then.
  std::string problem;
  DataSet data;             ///< rows in the order of visiting, as perfect instruments would read
  std::vector<Unit> units;  ///< the same, one or two rows each
  int candidates = 0;       ///< units that were drawn
  int parameters = 0;       ///< of the observability: see PlanSystem
  bool aligned = false;     ///< see PlanSystem
  double sigma_before = 0;  ///< m, without any of the units
  double sigma_beyond = 0;  ///< m, of what no such unit tells (PlanSystem::sigma_beyond)
  PlanFigures random;       ///< of as many candidates at random: the median of several choices
  PlanFigures planned;
  double way = 0, way_random = 0;  ///< s, in the order of the plan and of a random one
  /// How the end position's sigma (m) grows when one unit after another is left out, always the
  /// one that tells least: by count of units, from 0.
  std::vector<double> curve;

  /// What is left of a sigma (m) without sigma_beyond: the part that configurations decide.
  double rest(double sigma) const;
};

/// The plan for the robot with parameters `xi`. Tells its progress where it can be given up.
ConfigurationPlan plan_configurations(const Robot& robot, const Eigen::VectorXd& xi,
                                      const PlanRequest& request, const Progress& progress = {});

}  // namespace selfcal
