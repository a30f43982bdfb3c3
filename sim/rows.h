// Stages of making rows: exact configurations, their repeats, and which of them are to judge.
#pragma once

#include "sim/scenario.h"
#include "sim/simulated.h"

namespace selfcal {

/// By set, the joints that its scenario locks; a name that the robot has not is a problem.
std::vector<std::vector<int>> locked_joints(const Scenario& scenario, const Robot& robot,
                                            Problems& problems);

/// Fills made.data.rows and made.truth.groups with exact readings at configurations that satisfy
/// the methods; `made` has its sets, xi and own values, and made.locked. Of repeated configurations
/// each row is there.
void take_rows(const Scenario& scenario, const Robot& robot, Simulated& made);

}  // namespace selfcal
