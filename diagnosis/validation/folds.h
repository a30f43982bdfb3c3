// Which rows judge together: blocks of those kept aside; without such, each third of the rows
// judges what the others find.
#pragma once

#include <vector>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// `data`, all of whose rows are `fit` rows, with those of one fold made `check` rows. A fold is
/// two of six stretches of each set's configurations in time (in_time), so that it leaves out
/// moments and places; repeats stay together.
DataSet with_fold(const DataSet& data, int fold);

/// By row of `data`, the number of its block among the `check` rows; -1 of the others. A block is
/// as many configurations of one set in time as the cube root of them all (as an interval by
/// blocks wants it), each with its repeats.
std::vector<int> validation_blocks(const DataSet& data);

}  // namespace selfcal
