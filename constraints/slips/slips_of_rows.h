// The slips that a person makes of the rows of a data set: each a way to read them otherwise.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A way in which the files may be wrong: what the robot or the rows would then be.
struct Slip {
  std::string what;                    ///< "j3 is read with the other sign"
  std::shared_ptr<const Robot> robot;  ///< null: as given
  std::optional<Observations> rows;    ///< nothing: as given
};

/// Signs, gear ratios and exchanges of joints, degrees, units of what was measured, exchanged
/// columns.
std::vector<Slip> slips_of_rows(const Robot& robot, const DataSet& data);

/// Joint `j` reads the same in every row.
bool is_silent(const Observations& rows, Eigen::Index j);

}  // namespace selfcal
