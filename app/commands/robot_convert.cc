// selfcal robot convert FILE: a robot from another program's file, or for another program.
#include <cstdio>
#include <memory>

#include "app/commands/foreign/convert_notes.h"
#include "app/commands/foreign/for_controller.h"
#include "app/commands/foreign/foreign_robot.h"
#include "app/commands/foreign/mended_model.h"
#include "app/commands/subcommand.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/urdf_text.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostModelBytes = std::size_t{16} << 20;

struct ConvertArguments : ForeignRobot {
  std::string to = "yaml", like, out;
};

Result<std::string> to_urdf(const Node& robot, const ConvertArguments& arguments) {
  const auto model = serial_model(robot, arguments.file, arguments.to);
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
  const auto chain = corrected_by(*model, arguments.file, original->chain, arguments.like);
  if (!chain) return tl::unexpected(chain.error());
  note_base(*chain);
  const auto made = urdf_like(*text, arguments.like, *original, *chain);
  if (!made) return tl::unexpected(made.error());
  note_left_out(made->left_out);
  note(
      "give it to the driver as robot_description: its origins hold the offsets of the joints, "
      "too, so no kinematics file "
      "and no offsets beside it; calibration elements are left as they are");
  return made->text;
}

Result<std::string> to_mjcf(const Node& robot, const ConvertArguments& arguments) {
  const auto made = arguments.like.empty()
                        ? mjcf_of_robot(robot, arguments.file)
                        : mjcf_mended(robot, arguments.file, arguments.like, arguments.ends.tip);
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
  return for_controller(*node,
                        {arguments.to, arguments.file, arguments.like, arguments.convention});
}

int convert(const ConvertArguments& arguments) {
  if (!arguments.like.empty() && arguments.to != "urdf" && arguments.to != "mjcf" &&
      arguments.to != "ur")
    return wrong_usage("--like needs --to urdf, --to mjcf or --to ur");
  if (arguments.to == "ur" && arguments.like.empty())
    return wrong_usage(
        "--to ur needs --like FILE, the kinematics file that calibration_correction wrote for this "
        "robot: its links and its hash, which the driver compares with the controller, are kept");
  if (!arguments.convention.empty() && !is_table(arguments.file) && arguments.to != "dh")
    return wrong_usage("--convention is of a table: FILE.csv, or --to dh");
  if (arguments.to == "dh" && arguments.convention.empty())
    return wrong_usage("--to dh needs --convention standard or modified, as the controller has it");
  const auto text = read_file(arguments.file, kMostModelBytes);
  if (!text) return tell(text.error());
  const bool ends = !arguments.ends.base.empty() || !arguments.ends.tip.empty();
  const bool like_model =
      (arguments.to == "urdf" || arguments.to == "mjcf") && !arguments.like.empty();
  if (ends && !looks_like_xml(*text) && !like_model)
    return wrong_usage("--base and --tip choose a chain of a URDF, and there is none");
  if (!arguments.fixed.empty() && !is_urdf(*text))
    return wrong_usage("--fixed is of the fixed joints of a URDF, and there is none");
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
      ->add_option("--fixed", arguments->fixed,
                   "Fixed joints of the URDF: merge them into the frames beside them (default), or "
                   "keep each as a whole pose, which a calibration may correct by itself")
      ->check(CLI::IsMember({"merge", "keep"}));
  command
      ->add_option("--to", arguments->to,
                   "yaml: a robot file; urdf; mjcf: a model for MuJoCo; for controllers offsets: "
                   "of joints, with base and tool; dh: a table; ur: kinematics of Universal "
                   "Robots' driver; delta: lines for printers' firmwares")
      ->check(CLI::IsMember({"yaml", "urdf", "mjcf", "offsets", "dh", "ur", "delta"}))
      ->capture_default_str();
  command->add_option(
      "--like", arguments->like,
      "URDF, model for MuJoCo or UR kinematics whose joints get the calibrated poses");
  command->add_option("--out", arguments->out, "File to write (default: standard output)");
  command->callback([arguments, &status] { status = convert(*arguments); });
}

}  // namespace selfcal
