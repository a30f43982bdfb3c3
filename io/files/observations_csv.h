// The rows of a data set from their CSV file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "io/files/column_map.h"
#include "io/files/plausible.h"
#include "io/result.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Reads the rows for `data.sets` (each with its method) into `data.rows`; names of groups that the
/// rows bring up are appended to their set's. Every known column is validated, the ones that
/// Observations lacks are then dropped. What a person should know of a file that is accepted is
/// appended to `notices`. A file that another program wrote is read as `map` says; semicolons or
/// tabs may stand between the cells of any, and decimal commas in numbers then. After a failure
/// `data` is not to be used.
Result<void> read_observations(const std::filesystem::path& path, const Robot& robot,
                               const ColumnMap& map, Readings readings, DataSet& data,
                               std::vector<std::string>& notices);

/// The same of rows at which nothing need have been measured: set, group and readings are asked
/// for, columns that methods bring along are passed over.
Result<void> read_configurations(const std::filesystem::path& path, const Robot& robot,
                                 DataSet& data);

}  // namespace selfcal
