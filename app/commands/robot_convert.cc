// selfcal robot convert FILE: a robot from another program's file, or for another program.
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/urdf.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostModelBytes = std::size_t{16} << 20;

struct ConvertArguments {
  std::string file, out;
  UrdfEnds ends;
};

void print_converted_notices(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices)
    std::fprintf(stderr, "selfcal: note: %s\n", notice.c_str());
}

/// The robot file that `text`, a URDF or a robot file, comes to.
Result<std::string> as_robot_file(const std::string& text, const ConvertArguments& arguments) {
  if (!looks_like_xml(text)) {
    const auto robot = robot_of(text, arguments.file);
    if (!robot) return tl::unexpected(robot.error());
    return robot_text(**robot, values(**robot));
  }
  const auto urdf = read_urdf(text, arguments.file, arguments.ends);
  if (!urdf) return tl::unexpected(urdf.error());
  print_converted_notices(urdf->notices);
  const std::string converted = "# From the URDF " + urdf->chain.name + ", " + urdf->ends.base +
                                " to " + urdf->ends.tip + "\n" +
                                write_yaml(serial::write(frames_of(urdf->chain)));
  if (const auto robot = robot_of(converted, arguments.file + ", converted"); !robot)
    return tl::unexpected(robot.error());
  return converted;
}

int convert(const ConvertArguments& arguments) {
  const auto text = read_file(arguments.file, kMostModelBytes);
  if (!text) return tell(text.error());
  const auto converted = as_robot_file(*text, arguments);
  if (!converted) return tell(converted.error());
  if (arguments.out.empty()) {
    std::fwrite(converted->data(), 1, converted->size(), stdout);
    return kDone;
  }
  const auto written = write_file_atomically(arguments.out, *converted);
  return written ? kDone : tell(written.error());
}

}  // namespace

void add_robot_convert(CLI::App& robot, int& status) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = robot.add_subcommand(
      "convert", "A robot file from a URDF or a standard DH table (see man selfcal)");
  command->add_option("FILE", arguments->file, "URDF or NAME.robot.yaml")->required();
  command->add_option("--base", arguments->ends.base,
                      "Link of the URDF that the chain begins at (default: the root)");
  command->add_option("--tip", arguments->ends.tip,
                      "Link of the URDF that the chain ends at (default: the only end)");
  command->add_option("--out", arguments->out, "File to write (default: standard output)");
  command->callback([arguments, &status] { status = convert(*arguments); });
}

}  // namespace selfcal
