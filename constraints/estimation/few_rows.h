// A fit of very many rows goes over a few of them first.
#pragma once

#include <optional>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// Some of the rows that identify, taken as chance has it: the same ones every time, and none of a
/// rhythm that the rows may have. Sets with groups keep all of theirs. Nothing where the rows are
/// not many, or nearly all would be taken.
std::optional<DataSet> few_of(const DataSet& data);

}  // namespace selfcal
