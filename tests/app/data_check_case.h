// A sound data set of a simulated arm, and what makes a slip in its files.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "kinematics/description.h"
#include "tests/app/program.h"
#include "tests/support/text.h"

namespace selfcal {

inline constexpr const char* kTable = R"(robot: arm
kind: serial
convention: standard
frames:
  - {name: base, joint: fixed, xyz: [0, 0, 0.1], rpy: [0, 0, 0]}
  - {name: j1, joint: revolute, r: 0.1807, alpha: pi/2, limits: [-0.3, 0.4]}
  - {name: j2, joint: revolute, d: -0.6127, limits: [-1.0, 1.0]}
  - {name: j3, joint: revolute, d: -0.57155, limits: [-1.0, 1.0]}
  - {name: j4, joint: revolute, r: 0.17415, alpha: pi/2, limits: [-1.0, 1.0]}
  - {name: j5, joint: revolute, r: 0.11985, alpha: -pi/2, limits: [-1.0, 1.0]}
  - {name: j6, joint: revolute, r: 0.11655, limits: [-1.0, 1.0]}
  - {name: tool, joint: fixed, xyz: [0.03, 0.02, 0.15], rpy: [0, 0, 0]}
)";

inline const std::string kErrors = R"(robot: arm.robot.yaml
seed: 1
errors: {length: 1.0e-3, angle: 1.0e-3, base_length: 5.0e-3, base_angle: 5.0e-3, tool_length: 2.0e-3, tool_angle: 2.0e-3}
sets:
)";
inline const std::string kScenario =
    kErrors +
    "  tracker: {method: location, noise: 2.0e-5, noise_angle: 2.0e-5, "
    "noise_true: 2.5e-5, rows: 60}\n";
inline const std::string kBar = kErrors + "  bar: {method: distance, noise: 2.0e-5, rows: 90}\n";
inline const std::string kLevels =
    kErrors + "  tilt: {method: inclinometers, noise_angle: 2.0e-5, rows: 90}\n";

/// Two theodolites, and touches that give the scale.
inline const std::string kTheodolites =
    kErrors +
    "  one: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 60}\n"
    "  two: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 60}\n"
    "  bar: {method: distance, noise: 2.0e-5, rows: 60}\n";

using Cells = std::vector<std::string>;

class DataCheck : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    std::ofstream(folder_ / "s.yaml") << kScenario;
    simulate(kTable);
  }

  void simulate(const std::string& robot) {
    std::ofstream(folder_ / "arm.robot.yaml") << robot;
    std::filesystem::remove_all(folder_ / "data");
    const Ran ran = run_selfcal("simulate " + (folder_ / "s.yaml").string() + " --out " +
                                (folder_ / "data").string());
    ASSERT_EQ(ran.status, 0) << ran.out;
  }

  void simulate_sets(const std::string& scenario) {
    std::ofstream(folder_ / "s.yaml") << scenario;
    simulate(kTable);
  }

  /// Of a robot whose table has `b` for each `a`, and `d` for each `c`.
  void simulate_again(const std::string& a, const std::string& b, const std::string& c,
                      const std::string& d) {
    std::string text = kTable;
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{c, d}})
      for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
        text.replace(at, from.size(), to);
    simulate(text);
  }

  /// Replaces `from`, which must be there, in a file.
  void change_text(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = text_of(folder_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(folder_ / file) << text;
  }
  void change_robot(const std::string& from, const std::string& to) {
    change_text("data/arm.robot.yaml", from, to);
  }

  void free_of_limits() {
    std::istringstream lines(text_of(folder_ / "data/arm.robot.yaml"));
    std::ostringstream out;
    for (std::string line; std::getline(lines, line);) {
      if (const size_t at = line.find(", limits"); at != std::string::npos)
        line = line.substr(0, at) + "}";
      out << line << "\n";
    }
    std::ofstream(folder_ / "data/arm.robot.yaml") << out.str();
  }

  /// Changes the named cells of every row.
  void change_rows(const Cells& columns, const std::function<void(std::vector<double>&)>& change) {
    std::istringstream lines(text_of(folder_ / "data/observations.csv"));
    std::ostringstream out;
    Cells header;
    for (std::string line; std::getline(lines, line);) {
      Cells cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
      } else {
        const auto cell = [&](const std::string& name) -> std::string& {
          return cells.at(static_cast<size_t>(std::ranges::find(header, name) - header.begin()));
        };
        cells.resize(header.size());  // of a line that ends in a comma the last cell is empty
        if (std::ranges::all_of(columns, [&](const auto& name) { return !cell(name).empty(); })) {
          std::vector<double> numbers;
          for (const std::string& name : columns) numbers.push_back(std::stod(cell(name)));
          change(numbers);
          for (size_t i = 0; i < columns.size(); ++i) cell(columns[i]) = format_number(numbers[i]);
        }
      }
      for (size_t i = 0; i < cells.size(); ++i) out << (i > 0 ? "," : "") << cells[i];
      out << "\n";
    }
    std::ofstream(folder_ / "data/observations.csv") << out.str();
  }

  void expect_likely_wrong(const std::string& what) {
    const Ran ran = run_selfcal("data check " + (folder_ / "data").string());
    EXPECT_EQ(ran.status, 1) << ran.out;
    EXPECT_THAT(ran.out, testing::HasSubstr("likely wrong: " + what));
  }
};

inline const Cells kReadings = {"q1", "q2", "q3", "q4", "q5", "q6"};

}  // namespace selfcal
