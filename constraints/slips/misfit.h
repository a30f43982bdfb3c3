// How far a robot as its maker says is from rows, when it is only put where they have it.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// What may move beside the base and the sets' own unknowns.
struct PlacedBy {
  bool tool = true;
  int zero_of = -1;  ///< a joint, whose zero may be anywhere
};

struct Misfit {
  double left = 0, tool_moved = 0;
  int equations = 0, unknowns = 0;
  double zero_moved = 0;  ///< rad or m, of the joint that was asked for
  bool lengths = true, any = false;
  std::vector<double> by_set = {};       ///< as `left`, of each set; 0 where it has no lengths
  std::vector<std::string> angles = {};  ///< what is told of sets whose angles do not fit
  double angle = 0;  ///< median of the angular residuals of the set with the largest (rad)
};

/// How far base and tool alone, and what else moves, bring the robot to the rows.
Misfit misfit(const Robot& robot, const DataSet& data, const PlacedBy& moves);

/// How far `values` of the robot's parameters put the tool from where its maker has it (m).
double tool_moved(const Robot& robot, const Eigen::VectorXd& values);

}  // namespace selfcal
