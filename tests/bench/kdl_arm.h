// The example as KDL has it: location and the derivatives to its six readings, which is all that it
// gives (those to the parameters are ours alone).
#pragma once

#include <functional>

#include "tests/bench/arm.h"

namespace selfcal::bench {

/// Location and joint Jacobian of the first row; answers something that needs both. The task
/// outlives it.
std::function<double()> kdl_row(const Task& task);

}  // namespace selfcal::bench
