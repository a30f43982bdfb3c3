// An identification in words: what a person reads on the terminal.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// Several lines: the result in one, the verdict, what moved, what cannot be known and why, the
/// rows put aside, what to do next. Lengths in mm, angles in mrad.
std::string summary(const DataSet& data, const Solution& solution);

/// What to do next, a sentence each.
std::vector<std::string> next_steps(const DataSet& data, const Solution& solution);

}  // namespace selfcal
