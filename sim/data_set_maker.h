// The rows that a simulated robot measures, and the truth behind them.
#pragma once

#include "kinematics/robot.h"
#include "sim/scenario.h"
#include "sim/simulated.h"

namespace selfcal {

/// Makes the data set of `scenario` with `robot` as the nominal robot. What the scenario asks of
/// the robot or the methods and cannot be had is a problem; the result is meaningless then, as it
/// is when rows are missing.
Simulated make_data_set(const Scenario& scenario, const Robot& robot, Problems& problems);

}  // namespace selfcal
