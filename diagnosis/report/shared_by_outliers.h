// Rows that are put aside as false and have something in common are perhaps not false: an effect
// that acts on few rows (one side of a play, what follows a stop) stands far from all others.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

/// What the rows put aside have in common far more often than chance has it (a set, the way a joint
/// was approached, a pause before, a third of the session), in words; empty where nothing is. The
/// chance is that of a draw without replacement (Fisher's exact test), for all that is asked of.
std::string shared_by_outliers(const DataSet& data, const std::vector<Joint>& joints,
                               const std::vector<Outlier>& outliers);

}  // namespace selfcal
