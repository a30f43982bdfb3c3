// Judging without rows kept aside: each third of the rows judges what the others find.
#pragma once

#include "constraints/methods/data_set.h"

namespace selfcal {

inline constexpr int kFolds = 3;

/// `data`, all of whose rows are `fit` rows, with those of one fold made `check` rows. A fold is
/// two of six stretches of each set's configurations in their order, so that it leaves out moments
/// and places; repeats stay together.
DataSet with_fold(const DataSet& data, int fold);

}  // namespace selfcal
