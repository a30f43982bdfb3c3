// A place touched once is told by its one touch, and tells nothing back: often a mistyped name.
#pragma once

#include <string>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// What a person is told of the groups of set number `s` that have no more rows than place them,
/// and no known distance from another; empty where there are none.
std::string lone_groups(const DataSet& data, int s);

}  // namespace selfcal
