// What to tell a controller that holds fewer numbers than a calibration finds: those of its numbers
// s with which its own model comes nearest to the calibrated robot, effects included,
//   minimise  sum over poses (|p - p*|^2 + (a angle)^2) / near^2 + sum (move / tolerance)^2,
//   xi = start + basis s,
// with a = 0.1 m, the arm at which a turn counts, and near = 1 um, so that numbers which no pose
// tells apart share what they move by their tolerances and cost nothing that could be measured.
#pragma once

#include <vector>

#include "kinematics/inverse/operating_point.h"

namespace selfcal {

/// Parameters that a controller usually takes (indices), of those that a calibration moves: base
/// and tool frames, the joints' offsets, nonzero r and d, angles that are no multiples of a quarter
/// turn; of a robot with loops all of them, which its inverse model holds.
std::vector<int> controller_parameters(const Robot& robot);

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

/// Of `robot` with parameters `xi` and of `real` as it is, over those of `q` (poses x joints) at
/// which both close; `real` stands there as it carries what `at` says.
EndsApart ends_apart(const Robot& robot, const Eigen::VectorXd& xi, const Robot& real,
                     const Eigen::MatrixXd& q, const OperatingPoint& at = {});

/// What the numbers come to that were found of `real`, by the parameters' names: those that the
/// controller does not hold have the maker's figures.
Eigen::VectorXd as_found(const Robot& geometry, const ControllerNumbers& numbers,
                         const Robot& real);

/// What to tell a controller whose model is `geometry`, without effects, of the robot `real`,
/// fitted over those of `q` (poses x joints) at which both close. What was found stays as it is
/// where it says all of it.
Eigen::VectorXd fit_controller(const Robot& geometry, const ControllerNumbers& numbers,
                               const Robot& real, const Eigen::MatrixXd& q,
                               const OperatingPoint& at = {});

}  // namespace selfcal
