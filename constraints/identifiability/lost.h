// What rows can never tell of a robot, and why: the directions of its parameters that leave every
// residual alone, named where they are motions of a frame, the size, or changes within one part.
#pragma once

#include <string>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/solution.h"

namespace selfcal {

/// The reasons for `count` directions that R (of structural rows, own unknowns being unknown) does
/// not tell of the parameters in `free_mask`; the counts sum to it.
std::vector<Lost> lost_directions(const Equations& equations, const Eigen::MatrixXd& R,
                                  const State& state, const std::vector<char>& free_mask,
                                  int count);

}  // namespace selfcal
