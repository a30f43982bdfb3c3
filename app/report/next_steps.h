// What to do after an identification.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// How the warning begins that says what is likely wrong with robot file or rows. It is all that is
/// said of what to do next, for other advice presumes that they belong together.
inline constexpr std::string_view kFilesFirst = "Look at the files first: ";

/// The rows that judge are met better in their middle, whatever a test says of so many.
bool seem_met_better(const Residuals& residual);

/// Half the rows kept aside are met so much worse than those that identify that they are of another
/// session, or of a machine that has changed.
bool lie_apart(const Residuals& residual);

/// What to do next, a sentence each.
std::vector<std::string> next_steps(const DataSet& data, const Solution& solution);

}  // namespace selfcal
