// A small data set from bytes: a robot, rows that the simulation makes for it by one or two
// methods, and then cells that were overwritten. It is written and loaded as any other, so that
// what no file may say never comes to the numerics.
#pragma once

#include <sstream>

#include "io/files/data_set_file.h"
#include "io/files/observations_text.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "sim/data_set_maker.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/given.h"

namespace selfcal {

/// A chain of 3 to 7 joints with numbers as bytes say, or one of the machines that data sheets
/// have.
inline std::string small_robot(Bytes& bytes) {
  static constexpr const char* kStewart =
      "robot: stewart\nkind: gough-stewart\nlegs:\n"
      "  - {base: [0.59, -0.10, 0], platform: [0.23, -0.26, -0.1], offset: 0, limits: [0.5, 1.2]}\n"
      "  - {base: [0.59, 0.10, 0], platform: [0.23, 0.26, -0.1], offset: 0, limits: [0.5, 1.2]}\n"
      "  - {base: [-0.20, 0.56, 0], platform: [0.11, 0.33, -0.1], offset: 0, limits: [0.5, 1.2]}\n"
      "  - {base: [-0.38, 0.46, 0], platform: [-0.34, 0.07, -0.1], offset: 0, limits: [0.5, 1.2]}\n"
      "  - {base: [-0.38, -0.46, 0], platform: [-0.34, -0.07, -0.1], offset: 0, limits: [0.5, "
      "1.2]}\n"
      "  - {base: [-0.20, -0.56, 0], platform: [0.11, -0.33, -0.1], offset: 0, limits: [0.5, "
      "1.2]}\n";
  static constexpr const char* kDelta =
      "robot: delta\nkind: linear-delta\ntowers:\n"
      "  - {radius: 0.105, angle: 3.6652, rod: 0.2153, endstop: 0.58, limits: [-0.35, 0]}\n"
      "  - {radius: 0.105, angle: 5.7596, rod: 0.2153, endstop: 0.58, limits: [-0.35, 0]}\n"
      "  - {radius: 0.105, angle: 1.5708, rod: 0.2153, endstop: 0.58, limits: [-0.35, 0]}\n";
  const int kind = bytes.below(8);
  if (kind == 0) return kStewart;
  if (kind == 1) return kDelta;
  static constexpr double kTwist[] = {0, 1.5707963267948966, -1.5707963267948966, 0.3};
  static constexpr double kLength[] = {0, 0.4, 0.7, 0.15, -0.2};
  std::ostringstream text;
  text << "robot: arm\nkind: serial\nframes:\n  - {name: base, joint: fixed}\n";
  for (int i = 0, joints = 3 + bytes.below(5); i < joints; ++i) {
    const bool slides = kind == 2 && i == 2;
    text << "  - {name: j" << i + 1 << ", joint: " << (slides ? "prismatic" : "revolute")
         << ", alpha: " << kTwist[bytes.below(4)] << ", d: " << kLength[bytes.below(5)]
         << ", r: " << kLength[bytes.below(5)];
    if (kind == 3) text << ", mass: " << 10 - i << ", com: [0.1, 0, 0.05]";
    if (kind > 3) text << ", limits: [-2, 2]";
    text << "}\n";
  }
  text << "  - {name: tool, joint: fixed, d: 0.05, theta: 1.1, r: 0.15}\n";
  return text.str();
}

/// What is simulated on it.
inline std::string small_scenario(Bytes& bytes) {
  static constexpr const char* kMethods[] = {"position",
                                             "position, frame: unknown",
                                             "position, point: unknown",
                                             "location",
                                             "distance",
                                             "fixed-point-distance",
                                             "fixed-point-distance, offset: unknown",
                                             "position-constraint",
                                             "location-constraint",
                                             "plane",
                                             "plane, probe_radius: 0.02",
                                             "plane-normal",
                                             "sphere",
                                             "sphere, radius: 0.1",
                                             "inclinometers",
                                             "circle-point, joint: j2",
                                             "locked-joint, lock: {leg: 2, joint: universal}"};
  static constexpr const char* kSizes[] = {"0", "1.0e-3", "1.0e-6", "0.1"};
  std::ostringstream text;
  text << "robot: robot.yaml\nseed: " << bytes.below(16)
       << "\nerrors: {length: " << kSizes[bytes.below(3)] << ", angle: " << kSizes[bytes.below(3)]
       << "}\ncheck: " << bytes.below(4) * 0.2 << "\nencoder_step: " << kSizes[bytes.below(3)]
       << "\n";
  if (bytes.byte() % 4 == 1) text << "repeats: {share: 0.5, times: 2}\n";
  text << "sets:\n";
  const int sets = 1 + (bytes.byte() % 4 == 1 ? 1 : 0);
  for (int s = 0; s < sets; ++s)
    text << "  s" << s << ": {method: " << kMethods[bytes.below(std::size(kMethods))]
         << ", noise: " << (bytes.byte() % 2 ? "2.0e-5" : "1.0e-9")
         << ", rows: " << 2 + bytes.below(14) << ", rows_per_group: " << 2 + bytes.below(4)
         << "}\n";
  return text.str();
}

/// Cells of the rows, the header first.
using CellTable = std::vector<std::vector<std::string>>;

inline CellTable cells_of(const std::string& csv) {
  CellTable table;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    table.emplace_back();
    std::size_t begin = 0;
    for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
      end = line.find(',', begin);
      table.back().push_back(line.substr(begin, end == std::string::npos ? end : end - begin));
    }
  }
  return table;
}

/// One thing that goes wrong with the rows.
inline void spoil(CellTable& table, Bytes& bytes) {
  const int what = bytes.below(8);
  const auto rows = static_cast<int>(table.size()) - 1;
  const auto a = static_cast<std::size_t>(1 + bytes.below(rows));
  const auto b = static_cast<std::size_t>(1 + bytes.below(rows));
  const auto column = static_cast<std::size_t>(bytes.below(static_cast<int>(table[0].size())));
  const std::string number = format_number(bytes.number());
  const auto each_row = [&](const auto& change) {
    for (std::size_t row = 1; row < table.size(); ++row) change(table[row][column]);
  };
  if (what == 0) table[a][column] = number;
  if (what == 1) table[a][column].clear();
  if (what == 2) table[a] = table[b];
  if (what == 3) each_row([&](std::string& cell) { cell = number; });
  if (what == 4) std::swap(table[a], table[b]);
  if (what == 5 && rows > 1) table.erase(table.begin() + static_cast<std::ptrdiff_t>(a));
  if (what == 6) table[a][column] = table[b][column];
  if (what == 7) each_row([&](std::string& cell) { cell = table[a][column]; });
}

inline std::string text_of(const CellTable& table) {
  std::string text;
  for (const auto& row : table)
    for (std::size_t i = 0; i < row.size(); ++i) text += row[i] + (i + 1 < row.size() ? "," : "\n");
  return text;
}

/// Nothing where the bytes come to no data set that loads.
inline std::optional<LoadedDataSet> small_data_set(Bytes& bytes) {
  const std::string robot_file = small_robot(bytes);
  const auto robot = robot_of(robot_file, "robot.yaml");
  promise(robot.has_value(), robot ? "" : robot.error().what);
  const auto node = parse_yaml(small_scenario(bytes), "scenario.yaml");
  promise(node.has_value(), node ? "" : node.error().what);
  Problems problems;
  const Scenario scenario = read_scenario(*node, problems);
  if (problems.any()) return std::nullopt;
  const Simulated made = make_data_set(scenario, **robot, problems);
  if (problems.any() || !made.unreached.empty()) return std::nullopt;

  CellTable table = cells_of(observations_text(made.data));
  for (int changes = 0; changes < 40 && !bytes.empty(); ++changes) spoil(table, bytes);
  const GivenFolder& folder = given_folder();
  folder.write("robot.yaml", robot_file);
  folder.write("observations.csv", text_of(table));
  auto loaded = load_data_set(
      folder.write("dataset.yaml", write_yaml(data_set_description(scenario, "robot.yaml"))));
  if (!loaded) return std::nullopt;
  return *std::move(loaded);
}

}  // namespace selfcal
