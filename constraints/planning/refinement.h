// Chosen configurations moved until nothing near them is better.
//
// Compass search (Kolda, Lewis and Torczon, SIAM Review 45, 2003): of each configuration in turn
// every joint is moved a step either way, the method's residual brought back to zero by Newton's
// steps of least length, and the best of what is within the limits taken if it raises the merit;
// where none does, steps are halved.
#pragma once

#include <vector>

#include "constraints/planning/design.h"
#include "constraints/planning/plan_equations.h"
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
};

/// Moves the units; returns how often one was moved. The merit never falls.
int refine(const Robot& robot, const PlanEquations& equations, const Objective& objective,
           Refined plan, const Progress& progress = {});

}  // namespace selfcal
