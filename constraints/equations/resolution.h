// How finely readings come, and what that is of the rows' noise.
#pragma once

#include "constraints/equations/equations.h"

namespace selfcal {

/// Step to which each joint's readings `q` (rows x joints) are rounded (rad or m): the largest of
/// 1, 2, 5 times a power of ten that they are all multiples of; 0 below 1e-9.
Eigen::VectorXd reading_steps(const Eigen::MatrixXd& q);

/// What errors of the joints' readings do to equations.
struct ReadingErrors {
  Eigen::MatrixXd by_joint;  ///< equations x joints, sigmas a rad or m
  Eigen::VectorXd steps;     ///< that the readings are rounded to (rad or m); 0: not known
};

/// reading_steps(q), but 0 of a joint that stands still, whose rounding is part of its zero, and of
/// one whose rounding alone would move the equations by more than all that is left of them: such
/// readings lie on a round grid without being rounded. `by_joint` as above.
Eigen::VectorXd credible_steps(const Eigen::MatrixXd& q, const Eigen::MatrixXd& by_joint);

/// By set, the mean square of what rounding of half a step moves its equations, over the variance
/// that `scale` gives them; 0 of a set without rows.
std::vector<double> resolution_shares(const Equations& equations, const State& state,
                                      const std::vector<Scale>& scale,
                                      const std::vector<char>& outlier);

}  // namespace selfcal
