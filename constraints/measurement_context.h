// Where and when the rows of a data set were taken, as effects ask for it.
#pragma once

#include "constraints/methods/data_set.h"
#include "kinematics/effect.h"

namespace selfcal {

/// `robot` gives the places of the rows by its own values. The direction that a set's normal points
/// in is taken from its rows or, where these have none, from the side that the robot is on.
MeasurementContext context_of(const Robot& robot, const DataSet& data);

/// `robot` with its effects as they act on these rows: a surface's on the rows of its set, none of
/// a surface that the data set lacks, and what its file leaves to the rows by these. The robot
/// itself when it has no effects; null after a problem, an effect that these rows cannot have.
std::shared_ptr<const Robot> in_context(std::shared_ptr<const Robot> robot, const DataSet& data,
                                        Problems& problems);

}  // namespace selfcal
