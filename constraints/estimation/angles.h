// Whether the angles of a set are what the robot's geometry leaves of them, and what slip of the
// data would explain it where they are not.
#pragma once

#include <string>
#include <vector>

#include "constraints/estimation/judgement.h"

namespace selfcal {

/// Of each set whose angles are left larger than noise and tolerances explain: its name, how large
/// they are, and the slip that explains them, or where to look for one. In words.
std::vector<std::string> gross_angles(const Robot& robot, const DataSet& data, const Judged& before,
                                      const Judged& after);

}  // namespace selfcal
