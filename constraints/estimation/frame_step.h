// The frame in which a set's positions are given moves at a moment: the instrument was pushed, or
// the robot's base. From a row on everything lies otherwise by one rigid motion, which leaves a
// step in what a calibration of all rows leaves.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Rows on either side of a step, at least.
inline constexpr int kFewestBesideStep = 20;

/// The largest step of each set of positions or locations that is plainly one: it explains its
/// share, more than a shift of the tool or of a joint's zero at the same row does, and comes from
/// one row to the next. `xi`: of the calibrated robot; `rows`: of residual_figures.
std::vector<FrameStep> frame_steps(const Robot& robot, const Eigen::VectorXd& xi,
                                   const DataSet& data, const std::vector<RowFigure>& rows);

/// "from row 126 on the rows of set tracker lie otherwise by 4 mm and 0.2 mrad: …".
std::string step_words(const FrameStep& step);

}  // namespace selfcal
