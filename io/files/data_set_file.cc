// dataset.yaml: what was measured, on which robot, how well it is to be known. Paths in it are
// relative to its own folder.
#include "io/files/data_set_file.h"

#include <system_error>
#include <utility>

#include "constraints/measurement_context.h"
#include "io/files/observations_csv.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

constexpr double kDefaultTarget = 1.0e-3;  // m, 1 sigma
constexpr double kCoarsest = 1;            // m: no target is that coarse

/// What dataset.yaml says beside the sets.
struct Description {
  std::filesystem::path robot, observations;
  ColumnMap map = {};
};

Description read_description(const Node& node, DataSet& data, Problems& problems) {
  Fields fields(node, "data set", problems);
  Description description{fields.text("robot"), fields.text("observations")};
  if (fields.has("robot") && description.robot.empty()) fields.fail("robot", "a file's name");
  if (fields.has("observations") && description.observations.empty()) {
    fields.fail("observations", "a file's name");
  }
  data.target = fields.positive("target", kDefaultTarget);
  if (data.target >= kCoarsest) fields.fail("target", "metres below 1 (millimetres?)");
  if (const Node* workspace = fields.node("workspace"))
    data.workspace = read_workspace(*workspace, problems);
  const std::string dq = fields.text("dq", "velocity");
  if (dq != "velocity" && dq != "sign") fields.fail("dq", "velocity or sign");
  data.speeds = dq == "velocity";
  description.map = read_column_map(fields, problems);
  const Node* sets = fields.node("sets");
  if (sets == nullptr) fields.fail("sets", "a mapping of sets");
  fields.refuse_unknown();
  if (sets != nullptr) data.sets = read_sets(*sets, problems);
  description.map.sole_set = description.map.any() && data.sets.size() == 1;
  return description;
}

/// The folder's own name, also when it is given as "." or with a slash at its end.
std::string folder_name(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::canonical(folder, error);
  return (error ? folder : whole).filename().string();
}

}  // namespace

Result<LoadedDataSet> load_data_set(const std::filesystem::path& path, Readings readings) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error);
  const std::filesystem::path file = is_folder ? path / "dataset.yaml" : path;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";

  const Result<Node> node = read_yaml(file);
  if (!node) return tl::unexpected(node.error());
  LoadedDataSet loaded;
  loaded.name = folder_name(folder);
  Problems problems;
  const Description description = read_description(*node, loaded.data, problems);
  if (problems.any()) return bad_input(problems);
  loaded.files = {file.filename(), description.robot, description.observations};

  Result<std::unique_ptr<Robot>> robot = load_robot(folder / description.robot);
  if (!robot) return tl::unexpected(robot.error());
  loaded.robot = std::move(*robot);
  if (const std::string why = lacking_body(*loaded.robot, loaded.data.sets); !why.empty())
    return bad_input(file.string() + ": " + why);
  const Result<void> read =
      read_observations(folder / description.observations, *loaded.robot, description.map, readings,
                        loaded.data, loaded.notices);
  if (!read) return tl::unexpected(read.error());
  if (const std::string why = lacking_reference(loaded.data); !why.empty())
    return bad_input(file.string() + ": " + why);
  loaded.robot = in_context(std::move(loaded.robot), loaded.data, problems);
  if (problems.any()) return bad_input(problems);
  return loaded;
}

}  // namespace selfcal
