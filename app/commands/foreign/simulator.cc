#include "app/commands/foreign/simulator.h"

#include <algorithm>

#include "app/commands/foreign/mended_model.h"
#include "app/report/format.h"
#include "constraints/estimation/identification.h"
#include "constraints/methods/data_set.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/mjcf_effects.h"
#include "io/models/mujoco.h"
#include "kinematics/expects.h"
#include "kinematics/make_robot.h"

namespace selfcal {
namespace {

/// 1 sigma of one coordinate (m) that the simulated rows are taken for: far below any instrument's
/// on a real robot, far above what a balance of forces leaves open.
constexpr double kSimulatedNoise = 1e-6;

constexpr const char* kCorrectedName = "corrected.robot.yaml";

std::vector<MujocoLoad> loads_of(const Observations& rows) {
  std::vector<MujocoLoad> loads;
  for (int row = 0; row < rows.rows(); ++row) {
    MujocoLoad load;
    load.q = rows.q.row(row).transpose();
    if (rows.wrench.rows() > 0 && rows.wrench.row(row).allFinite()) {
      load.force = rows.wrench.row(row).head<3>().transpose();
      load.moment = rows.wrench.row(row).tail<3>().transpose();
    }
    loads.push_back(std::move(load));
  }
  return loads;
}

/// A name that no set of the machine's has: one name would be one instrument.
std::string free_set_name(const std::filesystem::path& file, const DataSet& real) {
  std::string name = file.stem().string();
  while (std::ranges::find(real.sets, name, &Set::name) != real.sets.end()) name += "_";
  return name;
}

Set position_set(const std::string& name, const DataSet& real) {
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("position"))).set("noise", Node::of(kSimulatedNoise));
  const auto all = [&](bool (Method::*is)() const) {
    return std::ranges::all_of(real.sets, [&](const Set& set) { return (*set.method.*is)(); });
  };
  if (all(&Method::frame_unknown)) entry.set("frame", Node::of(std::string("unknown")));
  if (all(&Method::point_unknown)) entry.set("point", Node::of(std::string("unknown")));
  Problems problems;
  Set set = make_set(name, entry, problems);
  expects(problems.list.empty(), "the entry of a set that is made here is sound");
  return set;
}

Observations simulated_rows(const Observations& real, const ToolPoses& tool) {
  std::vector<int> at_rest;
  for (int row = 0; row < real.rows(); ++row)
    if (tool[static_cast<std::size_t>(row)]) at_rest.push_back(row);
  const Observations kept = taken(real, at_rest);
  Observations rows;
  rows.q = kept.q;
  rows.wrench = kept.wrench;
  rows.time = kept.time;
  rows.check = kept.check;
  rows.set.assign(at_rest.size(), 0);
  rows.group.assign(at_rest.size(), -1);
  rows.position.resize(rows.rows(), 3);
  for (int i = 0; i < rows.rows(); ++i)
    rows.position.row(i) = tool[static_cast<std::size_t>(at_rest[i])]->p.transpose();
  return rows;
}

/// The robot of a file with those of its effects alone that a model for MuJoCo carries; where these
/// are not all, its parameters and theirs fitted to the rows anew, for what is left out would be
/// missing from what they came to beside it. What is left out is named in `left_out`.
std::optional<Node> fitted_without_the_rest(const Node& robot, const DataSet& data,
                                            std::vector<std::string>& left_out) {
  const Node* effects = robot.find("effects");
  Problems problems;
  const Node geometry = robot.without({"effects"});
  const serial::Model model = serial::read(geometry, problems);
  if (!effects || problems.any()) return robot;
  Node kept = Node::list();
  for (const Node& entry : effects->items) {
    Node one = Node::list();
    one.items = {entry};
    Node alone = geometry;
    const MjcfEffects taken = mjcf_effects(alone.set("effects", one), model);
    if (taken.carries_any())
      kept.items.push_back(entry);
    else
      left_out.insert(left_out.end(), taken.left_out.begin(), taken.left_out.end());
  }
  if (kept.items.size() == effects->items.size()) return robot;
  Node less = geometry;
  if (!kept.items.empty()) less.set("effects", kept);
  const auto fewer = make_robot(less, problems);
  if (!fewer || problems.any()) return std::nullopt;
  Options options;
  options.gears = true;
  for (const Parameter& each : fewer->parameters())
    if (each.part == Part::effect) options.free.push_back(each.name);
  const Solution solution = identify(*fewer, data, options);
  return parse_yaml(robot_text(*fewer, solution.values), kCorrectedName).value();
}

std::vector<std::string> notices_of(const MujocoPoses& poses) {
  const auto rows = std::to_string(poses.tool.size());
  std::vector<std::string> list;
  if (poses.driven > 0)
    list.push_back(
        "its joints stand at the readings; told these, its position actuators let the "
        "tool sag by " +
        mm(poses.sag) +
        " mm (rms), which is of the controller and not counted: the readings of a robot "
        "are where its joints are");
  if (poses.touching > 0)
    list.push_back("it touches something in " + std::to_string(poses.touching) + " of " + rows +
                   " rows");
  const auto lost = std::ranges::count(poses.tool, false, &std::optional<Location>::has_value);
  if (lost > 0)
    list.push_back(std::to_string(lost) + " of " + rows +
                   " rows are left out: it comes to no rest there");
  return list;
}

}  // namespace

bool is_simulator_model(const std::filesystem::path& path) {
  const std::string end = path.extension().string();
  return end == ".xml" || end == ".mjcf" || end == ".mjb" || end == ".urdf";
}

Result<Simulation> ask_simulator(const std::filesystem::path& file, const std::string& tool,
                                 const LoadedDataSet& real) {
  const auto poses = settled_poses(file, tool, loads_of(real.data.rows));
  if (!poses) return tl::unexpected(poses.error());
  if (std::ranges::count(poses->tool, false, &std::optional<Location>::has_value) ==
      std::ssize(poses->tool))
    return bad_input(file.string() + ": comes to rest at none of the rows of " + real.name);
  Simulation simulation;
  LoadedDataSet& measured = simulation.measured;
  measured.name = file.filename().string();
  measured.notices = notices_of(*poses);
  measured.files = {file};
  measured.data.target = real.data.target;
  measured.data.workspace = real.data.workspace;
  measured.data.order_is_time = real.data.order_is_time;
  measured.data.sets = {position_set(free_set_name(file, real.data), real.data)};
  measured.data.rows = simulated_rows(real.data.rows, poses->tool);
  simulation.tool = poses->tool;
  return simulation;
}

std::optional<MendedSimulator> mended_simulator(const std::filesystem::path& file,
                                                const std::string& tool, const LoadedDataSet& real,
                                                const std::string& corrected,
                                                const std::vector<Outlier>& outliers) {
  const auto all = parse_yaml(corrected, kCorrectedName);
  if (!all || all->find("kind")->text != "serial") return std::nullopt;
  std::vector<std::string> left_out;
  const auto robot = fitted_without_the_rest(*all, real.data, left_out);
  if (!robot) return std::nullopt;
  auto model = mjcf_mended(*robot, kCorrectedName, file.string(), tool);
  const bool own = model.has_value();
  if (!own) model = mjcf_of_robot(*robot, kCorrectedName);
  if (!model) return std::nullopt;
  const auto poses =
      settled_poses(own ? file : file.parent_path() / "mended.xml", own ? tool : std::string(),
                    loads_of(real.data.rows), model->text);
  if (!poses) return std::nullopt;
  if (!own)
    left_out.insert(
        left_out.begin(),
        "all of the model but the robot's own bodies, for it is not of this robot file");
  left_out.insert(left_out.end(), model->left_out.begin(), model->left_out.end());
  return MendedSimulator{model->text,
                         simulator_gap(real.data, without_false_rows(poses->tool, outliers)),
                         std::move(left_out)};
}

}  // namespace selfcal
