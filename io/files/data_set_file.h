// A data set from its folder: dataset.yaml, the robot it names and the rows.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "io/files/plausible.h"
#include "io/result.h"
#include "kinematics/robot.h"

namespace selfcal {

struct LoadedDataSet {
  std::string name;                    ///< the folder's
  std::shared_ptr<const Robot> robot;  ///< as its file has it, its effects as they act on the rows
  DataSet data;                        ///< fits the robot: one column of q for each joint
  std::vector<std::string> notices;    ///< what a person should know of an accepted data set
  /// What it is made of, as dataset.yaml names them (relative to the folder); itself first.
  std::vector<std::filesystem::path> files;
};

/// Reads the data set at `path`, a folder or the dataset.yaml in it. Everything that a file breaks
/// is refused with its line, or its row and column.
Result<LoadedDataSet> load_data_set(const std::filesystem::path& path,
                                    Readings readings = Readings::within_limits);

}  // namespace selfcal
