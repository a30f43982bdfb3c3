// Rows that stand where others do, though nothing in their file says so.
#pragma once

#include <optional>
#include <string>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// Fills Observations::repeat where no column did, and says what is to be told of it. Rows that
/// come back to the configuration of an earlier one, at any time, are its repeats if there are ten
/// of them, for a few may be there by accident: all readings within a thousandth (rad; of half the
/// way of a joint that slides, see units_of_readings), of one set, group and part, each joint come
/// from the same side, the tool as much loaded and the air as warm, as far as columns say. Over so
/// short a way the robot's own errors change by a few hundredths: what such rows differ by is the
/// measurement's own, and what the robot does not repeat. Of fewer, those that have the readings
/// and the load of the row before in every digit, no more than kAtOnce later where both have their
/// times.
std::optional<std::string> label_repeats(const Robot& robot, DataSet& data);

}  // namespace selfcal
