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

/// How plain a step must be.
struct StepBounds {
  double share = 0.4;    ///< of the squares that calibration leaves, explained by it
  double plainly = 0.8;  ///< of the squares that the best other explanation leaves, at most left
};
/// For where a drift of a size that no base has is the other explanation.
inline constexpr StepBounds kSuspectedStep{0.25, 0.9};

/// The largest step of each set of positions or locations that is plainly one: it explains its
/// share, more than a shift of the tool or of a joint's zero at the same row does, and comes from
/// one row to the next. `xi`: of the calibrated robot; `rows`: of residual_figures.
std::vector<FrameStep> frame_steps(const Robot& robot, const Eigen::VectorXd& xi,
                                   const DataSet& data, const std::vector<RowFigure>& rows,
                                   const StepBounds& bounds = {});

/// "from row 126 on the rows of set tracker lie otherwise by 4 mm and 0.2 mrad: …".
std::string step_words(const FrameStep& step);

}  // namespace selfcal
