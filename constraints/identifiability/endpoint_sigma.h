// How sure the end position is over some poses, from the posterior of the parameters.
#pragma once

#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

struct EndpointQuestion {
  const Robot* robot = nullptr;
  Eigen::VectorXd xi;
  Eigen::MatrixXd unseen;      ///< 6 x k motions of the world to be removed (see gauge.h)
  bool point_unknown = false;  ///< remove the target's point in the last link as well
  Eigen::MatrixXd poses;       ///< poses x joints, readings
};

/// What one of each parameter does to the end position at every pose, without whatever the rows
/// cannot place, which is removed by least squares over the shifts of all poses.
struct EndpointDeviations {
  Eigen::MatrixXd shift;  ///< three rows a pose x parameters
  /// A, parameters x parameters, with which the rms over the poses of any covariance C of the
  /// parameters is sqrt(trace(A C)), and that of how the endpoint is turned; zero without poses.
  Eigen::MatrixXd weight, turn_weight;
  bool aligned = false;  ///< something was removed
};
EndpointDeviations endpoint_deviations(const EndpointQuestion& question);

/// Length of the end position's deviation (1 sigma, root of the trace of its covariance) over the
/// poses for covariance `C` of the parameters (zero for those exactly known), and of how the
/// endpoint is turned.
EndpointSigma endpoint_sigma(const EndpointDeviations& deviations, const Eigen::MatrixXd& C);

/// The rms of EndpointSigma for covariance `C` by EndpointDeviations' weight: as quick as a
/// product, for many covariances of one question. Zero of a `C` that takes more away than it gives.
double endpoint_rms(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C);

}  // namespace selfcal
