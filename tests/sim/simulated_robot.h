// A scenario as text, made into a data set with the example robot.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "sim/data_set_maker.h"

namespace selfcal {

inline std::filesystem::path example(const std::string& name) {
  return std::filesystem::path(SELFCAL_SOURCE_DIR) / "app/examples" / name;
}

inline const Robot& rx90() {
  static const std::unique_ptr<Robot> robot = std::move(*load_robot(example("rx90.robot.yaml")));
  return *robot;
}

inline Scenario scenario_of(const std::string& text) {
  Problems problems;
  const Scenario scenario = read_scenario(*parse_yaml(text, "scenario.yaml"), problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return scenario;
}

/// The data set of `text`, which must be one that can be made.
inline Simulated made(const std::string& text, const Robot& robot = rx90()) {
  Problems problems;
  Simulated result = make_data_set(scenario_of(text), robot, problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  EXPECT_EQ(result.unreached, "");
  return result;
}

/// The first problem of a scenario that is read or made, or nothing.
inline std::string problem_of(const std::string& text, const Robot& robot = rx90()) {
  Problems problems;
  const Scenario scenario = read_scenario(*parse_yaml(text, "scenario.yaml"), problems);
  if (!problems.any()) make_data_set(scenario, robot, problems);
  return problems.any() ? problems.list.front() : "";
}

/// Residuals of all rows at the truth, fit and check alike.
inline std::vector<RowResidual> residuals_at_truth(const Simulated& simulated,
                                                   const Robot& robot = rx90()) {
  DataSet all = simulated.data;
  all.rows.check.assign(all.rows.check.size(), 0);
  return Equations(robot, all, Use::fit).residuals(simulated.truth);
}

}  // namespace selfcal
