// An identification in words: what a person reads on the terminal.
#pragma once

#include <string>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// "Improved: the tool is met to 0.0215 mm instead of 2.08 mm …": the verdict in one sentence.
std::string headline(const Solution& solution);

/// Several lines: the verdict, what moved, what cannot be known and why, the rows put aside, what
/// to do next. Lengths in mm, angles in mrad.
std::string summary(const DataSet& data, const Solution& solution);

}  // namespace selfcal
