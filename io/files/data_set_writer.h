// A data set's folder, written whole.
#pragma once

#include <filesystem>
#include <string>

#include "constraints/methods/data_set.h"
#include "io/result.h"

namespace selfcal {

struct NewDataSet {
  Node description;        ///< of dataset.yaml; names the robot's file and `observations.csv`
  std::string robot_file;  ///< name in the folder
  std::string robot_text;
  const DataSet* data = nullptr;  ///< the rows
};

/// Fails when `folder` is there and holds something else than a data set that was written here:
/// measurements are never replaced.
Result<void> check_replaceable(const std::filesystem::path& folder);

/// Writes dataset.yaml, observations.csv and the robot's file into `folder`, which is made, or
/// whose old ones are replaced; other files in it stay. Until all is written dataset.yaml is
/// without content, which load_data_set refuses: a folder is never read half old and half new.
Result<void> write_data_set(const std::filesystem::path& folder, const NewDataSet& data_set);

}  // namespace selfcal
