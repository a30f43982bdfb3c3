// A scenario and its robot, parted by =====. A small one is simulated.
#include "sim/scenario.h"

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "sim/data_set_maker.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

constexpr int kMostRows = 8;

bool is_small(const Scenario& scenario) {
  int rows = 0;
  for (const SetScenario& set : scenario.sets) rows += std::min(set.rows, kMostRows + 1);
  return rows <= kMostRows;
}

void try_scenario(std::string_view input) {
  const auto parts = parts_of(input, 2);
  const auto node = parse_yaml(parts[0], "given.scenario.yaml");
  if (!node) return;
  Problems problems;
  const Scenario scenario = read_scenario(*node, problems);
  if (problems.any()) return;
  const auto robot = robot_of(parts[1], "robot.yaml");
  if (!robot || !is_small(scenario)) return;
  const Simulated made = make_data_set(scenario, **robot, problems);
  if (problems.any() || !made.unreached.empty()) return;
  promise(made.data.rows.rows() > 0 && made.data.rows.q.allFinite(), "rows without readings");
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_scenario(selfcal::text_of(data, size));
  return 0;
}
