// Rows of a data set to the text of a CSV file that read_observations reads back.
#pragma once

#include <string>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// A header and one line for each row. Columns that no row fills are left out, an empty cell is one
/// that the row lacks; numbers read back as the same bits.
std::string observations_text(const DataSet& data);

}  // namespace selfcal
