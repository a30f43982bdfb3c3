// Equations of two rows: what errors of the joints' readings in the former of them do.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"

namespace selfcal {

struct RowsBefore {
  std::vector<int> of;       ///< by row of the data set: the row before it, -1 of one that has none
  Eigen::MatrixXd by_joint;  ///< equations of dense() x joints, sigmas a rad or m
};

/// Of the same equations as `equations.dense(state, scale, outlier)`, which are `dense`; of none
/// where no set with rows here has equations of two rows. Where differences share a touch, the
/// rows before that one take part through `by_joint` of it.
RowsBefore rows_before(const Equations& equations, const State& state,
                       const std::vector<Scale>& scale, const std::vector<char>& outlier,
                       const DenseEquations& dense);

}  // namespace selfcal
