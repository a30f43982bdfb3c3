// The rows that a simulated robot measured, and the truth behind them.
#pragma once

#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"

namespace selfcal {

struct Simulated {
  DataSet data;                          ///< what a calibration sees
  State truth;                           ///< the robot, own and group values
  std::vector<std::vector<int>> locked;  ///< by set, joints that are held
  std::vector<int> false_rows;           ///< rows (from 0) that triggered wrongly, ascending
  std::string unreached;                 ///< why rows are missing; empty when all were taken
};

}  // namespace selfcal
