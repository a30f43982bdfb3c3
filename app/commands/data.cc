// selfcal data check FOLDER: a first look at rows and robot, and what is likely wrong with them.
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/report/format.h"
#include "constraints/estimation/first_look.h"
#include "io/files/data_set_file.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

constexpr std::size_t kShown = 3;

/// The file's robot with `change` made to its tree; null where that is no robot.
std::shared_ptr<const Robot> changed_robot(const Node& file, const auto& change) {
  Node node = file;
  change(node);
  auto robot = robot_of(write_yaml(node), "robot");
  return robot ? std::shared_ptr<const Robot>(*std::move(robot)) : nullptr;
}

/// Its table of numbers may be meant by the other convention; its tool may be missing.
std::vector<Slip> slips_of_robot(const Node& file) {
  std::vector<Slip> slips;
  const Node* kind = file.find("kind");
  if (!kind || kind->text != "serial") return slips;
  const Node* convention = file.find("convention");
  const bool standard = convention && convention->text == "standard";
  const auto other = changed_robot(file, [&](Node& node) {
    node = node.without({"convention"});
    if (!standard) node.set("convention", Node::of(std::string("standard")));
  });
  if (other)
    slips.push_back({standard
                         ? "the table is modified DH and no standard one (convention: modified)"
                         : "the table is standard DH (convention: standard)",
                     other,
                     {}});
  const Node* frames = file.find("frames");
  const Node* last =
      frames && !frames->items.empty() ? frames->items.back().find("joint") : nullptr;
  if (!last || last->text == "fixed") return slips;
  const auto with_tool = changed_robot(file, [](Node& node) {
    Node tool = Node::map();
    tool.set("name", Node::of(std::string("tool_frame")))
        .set("joint", Node::of(std::string("fixed")))
        .set("xyz", Node::of(std::vector<double>{0, 0, 0}));
    for (std::size_t i = 0; i < node.keys.size(); ++i)
      if (node.keys[i] == "frames") node.items[i].items.push_back(tool);
  });
  if (with_tool)
    slips.push_back(
        {"the robot file lacks a tool frame (a fixed one at its end, xyz)", with_tool, {}});
  return slips;
}

std::string size_of_misfit(const FirstLook& look, double left) {
  return look.lengths ? mm(left) + " mm" : mm(left) + " mrad";
}

int print_first_look(const FirstLook& look) {
  std::printf(
      "%s are left of half the rows with the robot as its file has it, base and tool placed; "
      "the maker's tolerances leave about %s\n",
      size_of_misfit(look, look.left).c_str(), size_of_misfit(look, look.expected).c_str());
  if (look.found.empty()) {
    std::printf("nothing is likely wrong\n");
    return kDone;
  }
  std::printf("likely wrong: %s\n", look.found.c_str());
  if (look.tool)
    std::printf("  with the tool as its file has it %s are left; the rows put it %s mm away\n",
                size_of_misfit(look, look.tool_held).c_str(), mm(look.tool_moved).c_str());
  for (std::size_t i = 0; look.explained && i < std::min(kShown, look.tried.size()); ++i)
    std::printf("  %s where %s\n", size_of_misfit(look, look.tried[i].left).c_str(),
                look.tried[i].what.c_str());
  return kAnswerIsNo;
}

int data_check(const std::string& folder) {
  const auto loaded = load_data_set(folder);
  if (!loaded) return tell(loaded.error());
  print_notices(*loaded);
  const std::filesystem::path given = folder;
  const std::filesystem::path base =
      std::filesystem::is_directory(given) ? given : given.parent_path();
  const auto file = read_yaml(base / loaded->files[1]);
  if (!file) return tell(file.error());
  return print_first_look(first_look(loaded->robot, loaded->data, slips_of_robot(*file)));
}

}  // namespace

void add_data(CLI::App& app, int& status) {
  CLI::App* data = app.add_subcommand("data", "Work on data sets");
  data->require_subcommand(1);
  auto folder = std::make_shared<std::string>();
  CLI::App* command = data->add_subcommand(
      "check", "Say what is likely wrong with rows or robot; exit 1 if anything");
  command->add_option("FOLDER", *folder, "Data set: a folder or its dataset.yaml")->required();
  command->callback([folder, &status] { status = data_check(*folder); });
}

}  // namespace selfcal
