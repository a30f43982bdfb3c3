// The user's own simulator, a model that MuJoCo loads, asked at the configurations of a data set.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/report/page/diagnosis_page.h"
#include "diagnosis/comparison/simulator_gap.h"
#include "io/files/data_set_file.h"

namespace selfcal {

/// A model for MuJoCo, by its name's end (.xml, .mjcf, .mjb, .urdf), and no data set.
bool is_simulator_model(const std::filesystem::path& path);

struct Simulation {
  LoadedDataSet measured;  ///< its rows with the tool where the simulator puts it, as positions
  ToolPoses tool;          ///< the same by row of the machine's
};

/// Asks the model `file` at every row of `real`, whose joints the model must have; `tool` as
/// read_mujoco has it. The simulated rows are positions, seen by an instrument in the model's
/// world; its place is unknown where those of `real` are, and so is the target's. Wrenches of the
/// rows act on the tool.
Result<Simulation> ask_simulator(const std::filesystem::path& file, const std::string& tool,
                                 const LoadedDataSet& real);

/// The model `file`, or where it is none of MuJoCo's own or another robot's a model of the robot
/// alone, mended by the robot file `corrected` and asked at the same rows, of which those that are
/// false readings (`outliers`) judge nothing; nothing where there is no such model.
std::optional<MendedSimulator> mended_simulator(const std::filesystem::path& file,
                                                const std::string& tool, const LoadedDataSet& real,
                                                const std::string& corrected,
                                                const std::vector<Outlier>& outliers);

}  // namespace selfcal
