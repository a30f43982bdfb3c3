// Configurations that are measured more than once: at once, and again minutes later.
//
// Immediate repeats scatter as the measurement does. A second visit also brings along what the
// robot does not repeat: it has a noise of its own.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"

namespace selfcal {

/// By row, its visit: rows of one set and `repeat` are of one visit where, in time, none of another
/// configuration comes between them and no more than kAtOnce passes. Without times
/// the order of the rows is the time.
std::vector<int> visits(const Observations& rows);

/// 1 sigma that a visit adds to its rows, over that of immediate repeats: from what an explanation
/// leaves (`left`, by equation of `rows`) of the visits to one configuration. 0 where too few
/// configurations are both repeated at once and visited again.
double noise_of_visits(const Observations& data, const DenseEquations& rows,
                       const Eigen::VectorXd& left);

}  // namespace selfcal
