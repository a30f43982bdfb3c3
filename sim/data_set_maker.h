// The rows that a simulated robot measures, and the truth behind them.
#pragma once

#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"
#include "sim/scenario.h"

namespace selfcal {

struct Simulated {
  DataSet data;                          ///< what a calibration sees
  State truth;                           ///< the robot, own and group values
  std::vector<std::vector<int>> locked;  ///< by set, joints that are held
  std::vector<int> false_rows;           ///< rows (from 0) that triggered wrongly, ascending
  std::string unreached;                 ///< why rows are missing; empty when all were taken
};

/// Makes the data set of `scenario` with `robot` as the nominal robot. What the scenario asks of
/// the robot or the methods and cannot be had is a problem; the result is meaningless then, as it
/// is when rows are missing.
Simulated make_data_set(const Scenario& scenario, const Robot& robot, Problems& problems);

}  // namespace selfcal
