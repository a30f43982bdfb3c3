// Touches of two planes that the file has as one set.
#pragma once

#include <optional>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// The data set with those rows of set `set` in a set of their own that touch another plane than
/// most of it, with the robot as its file has it; nothing where the set is not of one plane that
/// nobody gave, or where its rows do not part into two of a fifth of them at the least.
std::optional<DataSet> parted_planes(const Robot& robot, const DataSet& data, int set);

}  // namespace selfcal
