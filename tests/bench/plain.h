// The core as a careful user would write it with Eigen: one configuration at a time, normal
// equations.
#pragma once

#include "tests/bench/arm.h"

namespace selfcal::bench {

/// The unknowns of the task, from its start to a relative change of the cost of 1e-10.
Eigen::VectorXd solve_plainly(const Task& task);

}  // namespace selfcal::bench
