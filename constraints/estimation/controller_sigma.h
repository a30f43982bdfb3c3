// How surely the end position is known where only some of the parameters are put to use.
#pragma once

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

struct ControllerSigma {
  std::vector<std::string> parameters;  ///< that it takes
  double left = 0;   ///< m, rms in the workspace: what it cannot follow of what was found
  double sigma = 0;  ///< m, 1 sigma of the end position then; negative where it is not known at all
};

/// Of the parameters that a controller usually takes (kinematics/inverse/controller_fit.h), moved
/// so that the maker's robot comes as near the calibrated one as it can where the end position
/// counts.
ControllerSigma controller_sigma(const Robot& robot, const DataSet& data, const Solution& solution);

}  // namespace selfcal
