// What to tell a controller that holds fewer numbers than a calibration finds: those of its numbers
// s with which its own model comes nearest to the calibrated robot, effects included,
//   minimise  sum over poses (|p - p*|^2 + (a angle)^2) / near^2 + sum (move / tolerance)^2,
//   xi = start + basis s,
// with a = 0.1 m, the arm at which a turn counts, and near = 1 um, so that numbers which no pose
// tells apart share what they move by their tolerances and cost nothing that could be measured.
#pragma once

#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// The parameters that a controller can hold: start + basis s.
struct ControllerNumbers {
  Eigen::VectorXd start;  ///< the maker's
  Eigen::MatrixXd basis;  ///< parameters x numbers
};

/// The maker's figures of `robot`, and of its parameters `taken` (indices) what it is told.
ControllerNumbers numbers_of_parameters(const Robot& robot, const std::vector<int>& taken);

/// How far the ends of two robots are apart over poses (m, rad).
struct EndsApart {
  double rms = 0, most = 0, rms_angle = 0;
  int poses = 0;
};
EndsApart ends_apart(const Robot& one, const Eigen::VectorXd& xi_one, const Robot& other,
                     const Eigen::VectorXd& xi_other, const Eigen::MatrixXd& q);

struct ControllerFit {
  Eigen::VectorXd xi;       ///< what to tell it
  EndsApart before, after;  ///< with `start` and with xi, of the poses that were not fitted
};

/// Fits every other pose of `q` (poses x joints, loops closed) and judges by the rest. `geometry`
/// is `real` without its effects: its values are taken as they are where they say all of it.
ControllerFit fit_controller(const Robot& geometry, const ControllerNumbers& numbers,
                             const Robot& real, const Eigen::MatrixXd& q);

}  // namespace selfcal
