#include "app/commands/support/file_slips.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "app/report/format.h"
#include "app/report/next_steps.h"
#include "constraints/slips/misfit.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// The file's robot with `change` made to its tree; null where that is no robot.
std::shared_ptr<const Robot> changed_robot(const Node& file, const auto& change) {
  Node node = file;
  change(node);
  auto robot = robot_of(write_yaml(node), "robot");
  return robot ? std::shared_ptr<const Robot>(*std::move(robot)) : nullptr;
}

/// The lengths of every frame times `factor`.
void scale_lengths(Node& node, double factor) {
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    if (node.keys[i] != "frames") continue;
    for (Node& frame : node.items[i].items)
      for (std::size_t k = 0; k < frame.keys.size(); ++k)
        if (frame.keys[k] == "d" || frame.keys[k] == "r")
          frame.items[k].text =
              format_number(factor * std::strtod(frame.items[k].text.c_str(), nullptr));
  }
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
  for (const double factor : {0.5, 2.0})
    if (auto scaled = changed_robot(file, [&](Node& node) { scale_lengths(node, factor); }))
      slips.push_back({std::string("the lengths in the robot's file are ") +
                           (factor < 1 ? "twice what they are, or those of the data set half"
                                       : "half what they are, or those of the data set twice"),
                       std::move(scaled),
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

}  // namespace

Result<FirstLook> look_at_files(const std::string& path, const LoadedDataSet& loaded,
                                const std::shared_ptr<const Robot>& robot) {
  const std::filesystem::path given = path;
  const std::filesystem::path folder =
      std::filesystem::is_directory(given) ? given : given.parent_path();
  const auto file = read_yaml(folder / loaded.files[1]);
  if (!file) return tl::unexpected(file.error());
  return first_look(robot, loaded.data, slips_of_robot(*file));
}

Failure with_likely_wrong(Failure refused, const std::string& path) {
  const auto loaded = load_data_set(path, Readings::any);
  if (!loaded) return refused;
  const auto look = look_at_files(path, *loaded, loaded->robot);
  if (look && !look->found.empty()) refused.what += "; likely wrong: " + look->found;
  return refused;
}

/// Of a gross misfit, that a calibration of rows that belong to the robot may leave.
constexpr double kMostLeftOfGross = 0.5;

LikelyWrong likely_wrong(const std::string& path, const LoadedDataSet& loaded,
                         const std::shared_ptr<const Robot>& robot, const NominalFit& nominal) {
  const double gross = gross_misfit(*robot, nominal.lengths);
  const double tool = nominal.lengths ? tool_moved(nominal.model, nominal.values) : 0;
  // Calibration takes in most of what the maker's tolerances leave.
  const bool taken_in = nominal.calibrated <= kMostLeftOfGross * gross;
  const bool turned = nominal.angle > gross_misfit(*robot, false);
  if (nominal.rms <= gross && tool <= gross && taken_in && !turned) return {};
  const auto look = look_at_files(path, loaded, robot);
  if (!look || look->found.empty()) return {};
  const std::string unit = look->lengths ? "mm" : "mrad";
  std::string text = std::string(kFilesFirst) + look->found;
  if (look->angles) return {text + "."};
  if (std::isinf(look->left))
    text += " (without this the robot of its file can take no row)";
  else if (look->explained)
    text += " (half the rows are off by more than " + plain_figure(1e3 * look->left) + " " + unit +
            ", without this by " + plain_figure(1e3 * look->tried.front().left) + " " + unit + ")";
  else if (look->tool)
    text += " (the rows put the tool " + plain_figure(1e3 * look->tool_moved) +
            " mm from where its file has it)";
  else
    text += " (half the rows are off by more than " + plain_figure(1e3 * look->left) + " " + unit +
            ", the maker's tolerances leave about " + plain_figure(1e3 * look->expected) + " " +
            unit + ")";
  return {text + ".", look->explained, look->tool};
}

}  // namespace selfcal
