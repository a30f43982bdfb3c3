// What the robot's scale stands on: the lengths that the entries of sets give (a step, a distance
// between sockets, a radius), each tested against the others and against the maker's lengths.
#pragma once

#include "constraints/estimation/adjustment.h"
#include "constraints/identifiability/endpoint_sigma.h"

namespace selfcal {

/// The given lengths that carry the scale, their test, and what of the posterior follows from it.
struct ScaleJudgement {
  RobotScale scale;
  /// By column of the equations, one for each contradiction: what the unknowns would move by if the
  /// length that is contradicted were the wrong one. Adds its square to the covariance.
  std::vector<Eigen::VectorXd> doubts;
};

/// `R` is whitened, at `adjusted.fitted`, with the columns beside the unknowns; `weight` is that
/// of the end position. Nothing stands on given lengths where a length of the robot is held or
/// fixed, though they are tested; without priors, or where nothing is free, they are not.
ScaleJudgement judge_scale(const Equations& equations, const Adjusted& adjusted,
                           const Eigen::MatrixXd& R, const Eigen::MatrixXd& weight);

}  // namespace selfcal
