// A platform whose file is so far off that its loops do not close where it was measured.
#pragma once

#include <memory>

#include "io/files/data_set_file.h"

namespace selfcal {

/// The robot of a data set of locations as its chains say it one by one, where the loops of the
/// file's robot do not close at more than a tenth of the rows that identify; null where they do, or
/// where the rows are of another kind.
Result<std::shared_ptr<const Robot>> leg_start(const LoadedDataSet& loaded);

}  // namespace selfcal
