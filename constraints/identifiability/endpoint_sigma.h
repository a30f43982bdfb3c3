// How sure the end position is over the workspace, from the posterior of the parameters.
#pragma once

#include "constraints/methods/observations.h"
#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

struct EndpointQuestion {
  const Robot* robot = nullptr;
  Eigen::VectorXd xi;
  Eigen::MatrixXd covariance;          ///< of all parameters; zero for those exactly known
  Eigen::MatrixXd unseen;              ///< 6 x k motions of the world to be removed (see gauge.h)
  bool point_unknown = false;          ///< remove the target's point in the last link as well
  const Observations* data = nullptr;  ///< gives the range of joints without limits
  unsigned long long seed = 1;
  int poses = 500;
};

/// Length of the end position's deviation (1 sigma, root of the trace of its covariance) over poses
/// drawn uniformly within the joint limits, after removing by least squares over all poses whatever
/// the rows cannot place.
EndpointSigma endpoint_sigma(const EndpointQuestion& question);

}  // namespace selfcal
