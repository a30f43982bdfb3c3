// An identification in words: what a person reads on the terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// "Improved: the tool is met to 0.0215 mm instead of 2.08 mm …": the verdict in one sentence.
std::string headline(const Solution& solution);

/// Several lines: the verdict, what moved, what cannot be known and why, the rows put aside, what
/// to do next. Lengths in mm, angles in mrad.
std::string summary(const DataSet& data, const Solution& solution);

/// How the warning begins that says what is likely wrong with robot file or rows. It is all that is
/// said of what to do next, for other advice presumes that they belong together.
inline constexpr std::string_view kFilesFirst = "Look at the files first: ";

/// What to do next, a sentence each.
std::vector<std::string> next_steps(const DataSet& data, const Solution& solution);

}  // namespace selfcal
