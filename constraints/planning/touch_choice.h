// Which of many possible touches tell most together: each next one is the one that the parameters,
// as far as they are known from those before it and from the priors, predict worst.
//
// With C the covariance of the parameters and the surfaces, the variance that a touch w would show
// is w C wᵀ / sigma²; taking the largest raises det(C⁻¹) most (Fedorov 1972), and C is updated by
//   C -= C wᵀ w C / (sigma² + w C wᵀ).
#pragma once

#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A touch that could be made.
struct PossibleTouch {
  Eigen::VectorXd q;        ///< readings in the contact
  int set = 0, group = -1;  ///< group: of sockets and nests
  Eigen::Vector3d outward;  ///< of a surface (world, unit)
};

/// 1 sigma² of where a surface or socket lies, or how it is turned, that is not known (m², rad²).
inline constexpr double kPlaceVariance = 1;

/// 1 sigma of a touch of the set as its data sheet says (m), 20 um where it says none.
double touch_noise(const Set& set);
/// The same of an angle (rad).
double angle_noise(const Set& set);

/// Indices of the chosen candidates in the order of choice, as many of each set as `counts` says or
/// as there are. `xi` are the parameters that are believed.
std::vector<int> d_optimal_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                   const std::vector<Set>& sets,
                                   const std::vector<PossibleTouch>& candidates,
                                   std::vector<int> counts);

/// Covariance of the robot's parameters after the touches, from their priors and each set's noise
/// (20 um where a set says none); the surfaces and sockets are unknown.
Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches);

}  // namespace selfcal
