// A platform on six chains from locations of it, when little is known: the inverse model parts into
// one problem a chain (Khalil and Dombre, 11.7.1), which needs no direct model and no loop to
// close.
#pragma once

#include <string>

#include "constraints/methods/data_set.h"
#include "kinematics/robots/platform.h"

namespace selfcal {

struct LegFigures {
  Eigen::VectorXd xi;   ///< of the platform; empty after a problem
  double rms = 0;       ///< m, what is left of the chains' lengths
  int rows = 0;         ///< that were used
  std::string problem;  ///< why there is none
};

/// True when all rows that identify are locations in the base's own frame.
bool of_locations_alone(const DataSet& data);

/// Values of a platform's parameters that fit the rows best, chain by chain, from `start`.
LegFigures leg_figures(const platform::Platform& robot, const DataSet& data,
                       const Eigen::VectorXd& start);

}  // namespace selfcal
