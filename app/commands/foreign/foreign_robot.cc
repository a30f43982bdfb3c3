#include "app/commands/foreign/foreign_robot.h"

#include <cstdio>
#include <filesystem>

#include "app/commands/subcommand.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/dh_table.h"
#include "io/models/mujoco.h"
#include "io/models/ur_kinematics.h"

namespace selfcal {
namespace {

/// The robot file of `text`, after a line that says where it is from.
Result<std::string> robot_file(const std::string& text, const std::string& origin,
                               const ForeignRobot& foreign) {
  const std::string converted = "# From " + origin + "\n" + text;
  if (const auto robot = robot_of(converted, foreign.file + ", converted"); !robot)
    return tl::unexpected(robot.error());
  return converted;
}

Result<std::string> chain_file(const JointChain& chain, const std::string& origin,
                               const ForeignRobot& foreign) {
  const FixedJoints fixed = foreign.fixed == "keep" ? FixedJoints::kept : FixedJoints::merged;
  return robot_file(write_yaml(serial::write(frames_of(chain, fixed))), origin, foreign);
}

/// A model of MuJoCo's own, which its first element tells.
bool is_mjcf(const std::string& text) { return text.find("<mujoco") != std::string::npos; }

Result<std::string> from_mjcf(const ForeignRobot& foreign) {
  if (!foreign.ends.base.empty())
    return tl::unexpected(
        Failure{kWrongUsage,
                "--base chooses a link of a URDF: a model for MuJoCo is taken from its world"});
  const auto model = read_mujoco(foreign.file, foreign.ends.tip);
  if (!model) return tl::unexpected(model.error());
  for (const std::string& notice : model->notices) note(notice);
  return chain_file(model->chain,
                    "the MuJoCo model " + model->chain.name + ", its world to " + model->tool,
                    foreign);
}

/// A URDF or a model for MuJoCo by its name.
bool should_be_xml(const std::filesystem::path& file) {
  const std::string end = file.extension().string();
  return end == ".urdf" || end == ".xacro" || end == ".xml" || end == ".mjcf";
}

/// The kinematics file of Universal Robots' driver, which one key tells.
bool is_ur_kinematics(const std::string& text, const ForeignRobot& foreign) {
  const auto node = parse_yaml(text, foreign.file);
  return node && node->find("kinematics") && !node->find("frames");
}

/// Its joints have the names that the driver's readings have.
Result<std::string> from_ur(const std::string& text, const ForeignRobot& foreign) {
  static constexpr const char* kReadings[] = {"shoulder_pan_joint", "shoulder_lift_joint",
                                              "elbow_joint",        "wrist_1_joint",
                                              "wrist_2_joint",      "wrist_3_joint"};
  auto read = read_ur_kinematics(text, foreign.file);
  if (!read) return tl::unexpected(read.error());
  for (std::size_t j = 0; j < read->chain.joints.size(); ++j)
    read->chain.joints[j].name = kReadings[j];
  note(
      "the world is base_link_inertia of the driver, the end the flange wrist_3; the file has no "
      "limits, masses and tool");
  return chain_file(read->chain, "Universal Robots' kinematics " + read->hash, foreign);
}

Result<std::string> from_table(const ForeignRobot& foreign) {
  if (foreign.convention.empty())
    return tl::unexpected(Failure{
        kWrongUsage,
        "a table of alpha, a, d and theta is meant in one of two ways, which give different "
        "robots: say --convention standard (a row moves along z by d and then along x by a, as "
        "most data sheets have it) or --convention modified (after Craig, or Khalil)"});
  const auto table = read_dh_table(foreign.file, foreign.convention);
  if (!table) return tl::unexpected(table.error());
  const auto fixed = [](const Node& frame) { return frame.find("joint")->text == "fixed"; };
  const std::vector<Node>& frames = table->find("frames")->items;
  if (!frames.empty() && !(fixed(frames.front()) && fixed(frames.back())))
    note(
        "base and tool are as the rows have them, whatever stands behind #: where they lack, put a "
        "fixed frame with xyz and rpy first and last; `selfcal robot check` shows the frames");
  return robot_file(write_yaml(*table),
                    "the table " + std::filesystem::path(foreign.file).filename().string(),
                    foreign);
}

Result<std::string> from_urdf(const std::string& text, const ForeignRobot& foreign) {
  const auto urdf = read_urdf(text, foreign.file, foreign.ends);
  if (!urdf) return tl::unexpected(urdf.error());
  for (const std::string& notice : urdf->notices) note(notice);
  return chain_file(
      urdf->chain,
      "the URDF " + urdf->chain.name + ", " + urdf->ends.base + " to " + urdf->ends.tip, foreign);
}

}  // namespace

void note(const std::string& what) { std::fprintf(stderr, "selfcal: note: %s\n", what.c_str()); }

bool is_urdf(const std::string& text) { return looks_like_xml(text) && !is_mjcf(text); }

bool is_table(const std::string& file) { return file.ends_with(".csv"); }

Result<std::string> as_robot_file(const std::string& text, const ForeignRobot& foreign) {
  if (is_table(foreign.file)) return from_table(foreign);
  if (is_urdf(text)) return from_urdf(text, foreign);
  if (is_mjcf(text)) return from_mjcf(foreign);
  if (should_be_xml(foreign.file))
    return bad_input(foreign.file + ":1: no XML, which a URDF and a model for MuJoCo are");
  if (is_ur_kinematics(text, foreign)) return from_ur(text, foreign);
  const auto robot = robot_of(text, foreign.file);
  if (!robot) return tl::unexpected(robot.error());
  return robot_text(**robot, values(**robot));
}

}  // namespace selfcal
