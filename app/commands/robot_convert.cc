// selfcal robot convert FILE: a robot from another program's file, or for another program.
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/commands/support/foreign_robot.h"
#include "app/report/format.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/delta_firmware.h"
#include "io/models/mjcf_text.h"
#include "io/models/ur_kinematics.h"
#include "io/models/urdf_text.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostModelBytes = std::size_t{16} << 20;

struct ConvertArguments : ForeignRobot {
  std::string to = "yaml", like, out;
};

void note_left_out(const std::vector<std::string>& all) {
  for (const std::string& each : all) note("left out: " + each);
}

/// Names what another program does not hold of a robot: its effects but for those that it `holds`.
void note_effects(const Node& robot, bool (*holds)(const Node& entry) = nullptr) {
  const Node* effects = robot.find("effects");
  if (!effects) return;
  for (const Node& entry : effects->items) {
    if (holds && holds(entry)) continue;
    const Node* name = entry.find("effect");
    const Node* at = entry.find("at");
    note("left out: the effect " + (name ? name->text : "?") +
         (at && !at->text.empty() ? " at " + at->text : ""));
  }
}

/// The same of a serial robot's gears, and of its coupling unless the program has it (`coupled`).
void note_transmissions(const serial::Model& model, bool coupled) {
  for (const serial::Frame& frame : model.frames)
    if (frame.gear != 1)
      note("left out: the gear ratio of " + frame.name + ", " + format_number(frame.gear) +
           ": positions there are the ratio times the reading");
  if (!coupled && model.coupling.size() > 0)
    note("left out: the coupling of joints: positions there are coupling times readings");
}

/// The serial robot that a robot file describes, its effects apart.
Result<serial::Model> serial_model(const Node& robot, const ConvertArguments& arguments) {
  if (robot.find("kind")->text != "serial")
    return bad_input(arguments.file + ": a robot of kind " + robot.find("kind")->text +
                     " has loops, and " + arguments.to + " holds chains of joints only");
  Problems problems;
  serial::Model model = serial::read(robot.without({"effects"}), problems);
  if (problems.any()) return bad_input(problems);
  return model;
}

Result<CorrectedChain> corrected(const JointChain& original, const serial::Model& model,
                                 const ConvertArguments& arguments) {
  CorrectedChain chain = corrected_chain(original, model);
  if (!chain.problem.empty())
    return bad_input(arguments.file + ": is no calibration of " + arguments.like + ": " +
                     chain.problem);
  const double length = chain.base.translation().norm();
  const double angle = log_rotation(chain.base.linear()).norm();
  if (length > 1e-9 || angle > 1e-9)
    note(
        printed("the base moves by %.3f mm and %.3f mrad, to where the data set's world has it; "
                "this goes into the first joint",
                1e3 * length, 1e3 * angle));
  return chain;
}

Result<std::string> to_urdf(const Node& robot, const ConvertArguments& arguments) {
  const auto model = serial_model(robot, arguments);
  if (!model) return tl::unexpected(model.error());
  note_effects(robot);
  note_transmissions(*model, !arguments.like.empty());
  if (arguments.like.empty()) {
    const UrdfText made = urdf_of(*model);
    note_left_out(made.left_out);
    return made.text;
  }
  const auto text = read_file(arguments.like, kMostModelBytes);
  if (!text) return tl::unexpected(text.error());
  const auto original = read_urdf(*text, arguments.like, arguments.ends);
  if (!original) return tl::unexpected(original.error());
  const auto chain = corrected(original->chain, *model, arguments);
  if (!chain) return tl::unexpected(chain.error());
  const auto made = urdf_like(*text, arguments.like, *original, *chain);
  if (!made) return tl::unexpected(made.error());
  note_left_out(made->left_out);
  note(
      "give it to the driver as robot_description: its origins hold the offsets of the joints, "
      "too, so no kinematics file "
      "and no offsets beside it; calibration elements are left as they are");
  return made->text;
}

/// A joint's compliance as one number, which MuJoCo has as a spring.
bool is_joint_spring(const Node& entry) {
  const Node *name = entry.find("effect"), *c = entry.find("c"), *at = entry.find("at");
  return name && name->text == "joint_compliance" && at && c &&
         written_number(c->text).value_or(0) > 0;
}

Result<std::string> to_mjcf(const Node& robot, const ConvertArguments& arguments) {
  const auto model = serial_model(robot, arguments);
  if (!model) return tl::unexpected(model.error());
  note_effects(robot, is_joint_spring);
  std::vector<JointSpring> springs;
  if (const Node* effects = robot.find("effects"))
    for (const Node& entry : effects->items)
      if (is_joint_spring(entry))
        springs.push_back({entry.find("at")->text, *written_number(entry.find("c")->text)});
  const MjcfText made = mjcf_of(serial::with_usual_masses(*model), springs);
  note_left_out(made.left_out);
  return made.text;
}

Result<std::string> to_ur(const Node& robot, const ConvertArguments& arguments) {
  const auto model = serial_model(robot, arguments);
  if (!model) return tl::unexpected(model.error());
  note_effects(robot);
  note_transmissions(*model, false);
  const auto text = read_file(arguments.like, kMostModelBytes);
  if (!text) return tl::unexpected(text.error());
  const auto original = read_ur_kinematics(*text, arguments.like);
  if (!original) return tl::unexpected(original.error());
  const auto chain = corrected(original->chain, *model, arguments);
  if (!chain) return tl::unexpected(chain.error());
  note_left_out(chain->left_out);
  const Eigen::Isometry3d tool = chain->chain.joints.back().X_WJ.inverse() * chain->chain.X_WT;
  if ((tool.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() > 1e-12)
    note("left out: the tool's correction, for the file ends at wrist_3");
  note(
      "give it to the driver as kinematics_params_file: it holds the offsets of the joints, too, "
      "so no corrected URDF and no offsets beside it");
  return ur_kinematics_text(chain->chain, original->hash);
}

Result<std::string> to_delta(const Node& robot, const ConvertArguments& arguments) {
  if (robot.find("kind")->text != "linear-delta")
    return bad_input(arguments.file + ": a robot of kind " + robot.find("kind")->text +
                     " is no linear-delta, which the firmwares of delta printers are for");
  Problems problems;
  const linear_delta::Delta delta = linear_delta::read(robot.without({"effects"}), problems);
  if (problems.any()) return bad_input(problems);
  note_effects(robot);
  const auto made = delta_firmware(delta, arguments.file);
  if (!made) return tl::unexpected(made.error());
  note_left_out(made->left_out);
  return made->text;
}

Result<std::string> converted(const std::string& robot, const ConvertArguments& arguments) {
  if (arguments.to == "yaml") return robot;
  const auto node = parse_yaml(robot, arguments.file);
  if (!node) return tl::unexpected(node.error());
  if (arguments.to == "urdf") return to_urdf(*node, arguments);
  if (arguments.to == "mjcf") return to_mjcf(*node, arguments);
  if (arguments.to == "ur") return to_ur(*node, arguments);
  return to_delta(*node, arguments);
}

int convert(const ConvertArguments& arguments) {
  if (!arguments.like.empty() && arguments.to != "urdf" && arguments.to != "ur")
    return wrong_usage("--like needs --to urdf or --to ur");
  if (arguments.to == "ur" && arguments.like.empty())
    return wrong_usage(
        "--to ur needs --like FILE, the kinematics file that calibration_correction wrote for this "
        "robot: its links and its hash, which the driver compares with the controller, are kept");
  if (!arguments.convention.empty() && !is_table(arguments.file))
    return wrong_usage("--convention is of a table (FILE.csv)");
  const auto text = read_file(arguments.file, kMostModelBytes);
  if (!text) return tell(text.error());
  const bool ends = !arguments.ends.base.empty() || !arguments.ends.tip.empty();
  const bool like_urdf = arguments.to == "urdf" && !arguments.like.empty();
  if (ends && !looks_like_xml(*text) && !like_urdf)
    return wrong_usage("--base and --tip choose a chain of a URDF, and there is none");
  const auto robot = as_robot_file(*text, arguments);
  if (!robot) return tell(robot.error());
  const auto made = converted(*robot, arguments);
  if (!made) return tell(made.error());
  if (arguments.out.empty()) {
    std::fwrite(made->data(), 1, made->size(), stdout);
    return kDone;
  }
  const auto written = write_file_atomically(arguments.out, *made);
  return written ? kDone : tell(written.error());
}

}  // namespace

void add_robot_convert(CLI::App& robot, int& status) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = robot.add_subcommand("convert",
                                           "A robot file from a URDF, a model for MuJoCo or UR "
                                           "kinematics, or a calibrated robot for another program");
  command
      ->add_option("FILE", arguments->file,
                   "URDF, model for MuJoCo, kinematics of Universal Robots' driver, table of "
                   "Denavit-Hartenberg numbers (.csv) or NAME.robot.yaml")
      ->required();
  command
      ->add_option("--convention", arguments->convention,
                   "Of a table: standard or modified, which give different robots")
      ->check(CLI::IsMember({"standard", "modified"}));
  command->add_option("--base", arguments->ends.base,
                      "Link of the URDF that the chain begins at (default: the root)");
  command->add_option("--tip", arguments->ends.tip,
                      "Link of the URDF, or site or body of the model, that the chain ends at "
                      "(default: the only one)");
  command
      ->add_option("--to", arguments->to,
                   "yaml: a robot file; urdf; mjcf: a model for MuJoCo; ur: kinematics of "
                   "Universal Robots' driver; delta: "
                   "lines for printers' firmwares")
      ->check(CLI::IsMember({"yaml", "urdf", "mjcf", "ur", "delta"}))
      ->capture_default_str();
  command->add_option("--like", arguments->like,
                      "URDF or UR kinematics whose joints get the calibrated poses");
  command->add_option("--out", arguments->out, "File to write (default: standard output)");
  command->callback([arguments, &status] { status = convert(*arguments); });
}

}  // namespace selfcal
