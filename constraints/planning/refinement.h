// Chosen configurations of any method moved until nothing near them is better (better_places.h):
// joints by the steps of a search, then the method's residual back to zero by Newton's steps of
// least length, within the limits.
#pragma once

#include <vector>

#include "constraints/planning/design.h"
#include "constraints/planning/plan_equations.h"
#include "constraints/planning/plan_pool.h"
#include "constraints/progress.h"

namespace selfcal {

/// A plan of all rows of `data`.
struct Refined {
  DataSet& data;
  const std::vector<Unit>& units;
  /// Those of the equations that the objective has.
  const std::vector<int>& columns;
  /// By set, the most that a unit's rows may be of: the norm of PlanEquations::of_units.
  const std::vector<double>& most;
  const std::vector<int>& held;  ///< joints that do not move
  double spacing = 0;            ///< m, kept between end positions of a set, and from `taken`
  EndPositions taken = {};
};

/// Moves the units; returns how often one was moved. The merit never falls.
int refine(const Robot& robot, const PlanEquations& equations, const Objective& objective,
           Refined plan, const Progress& progress = {});

}  // namespace selfcal
