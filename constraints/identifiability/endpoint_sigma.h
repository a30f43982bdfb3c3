// How sure the end position is over some poses, from the posterior of the parameters.
#pragma once

#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

struct EndpointQuestion {
  const Robot* robot = nullptr;
  Eigen::VectorXd xi;
  Eigen::MatrixXd covariance;  ///< of all parameters; zero for those exactly known
  Eigen::MatrixXd unseen;      ///< 6 x k motions of the world to be removed (see gauge.h)
  bool point_unknown = false;  ///< remove the target's point in the last link as well
  Eigen::MatrixXd poses;       ///< poses x joints, readings
};

/// Length of the end position's deviation (1 sigma, root of the trace of its covariance) over the
/// poses, after removing by least squares over all poses whatever the rows cannot place; and that
/// of how the endpoint is turned, of which the same motions of the world are removed.
EndpointSigma endpoint_sigma(const EndpointQuestion& question);

/// A, parameters x parameters, with which the rms of any covariance C is sqrt(trace(A C)); that of
/// the question is not looked at. Without poses it is zero.
Eigen::MatrixXd endpoint_weight(const EndpointQuestion& question);

/// The rms of EndpointSigma for covariance `C`, from endpoint_weight(): as quick as a product, for
/// many covariances of one question. Zero of a `C` that takes more away than it gives.
double endpoint_rms(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C);

}  // namespace selfcal
