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
/// Those of the angles that instruments measure: degrees, gons, signs, zenith angles for
/// elevations, exchanged columns, of the rows of one set or (-1) of all.
std::vector<Slip> slips_of_angles(const DataSet& data, int set);
/// How far the angles that instruments measured are from their set's means (rad, rms); 0 without
/// any.
double spread_of_angles(const DataSet& data, const Observations& rows);

/// Joint `j` reads the same in every row.
bool is_silent(const Observations& rows, Eigen::Index j);

}  // namespace selfcal
