#include "app/commands/support/simulated_robot.h"

#include <nlohmann/json.hpp>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"

namespace selfcal {

Result<Scenario> load_scenario(const std::string& path) {
  const Result<Node> node = read_yaml(path);
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  Scenario scenario = read_scenario(*node, problems);
  if (problems.any()) return bad_input(problems);
  return scenario;
}

Result<std::unique_ptr<Machine>> load_machine(const std::string& path, const Config& config) {
  const Result<Scenario> scenario = load_scenario(path);
  if (!scenario) return tl::unexpected(scenario.error());
  auto robot = load_robot(std::filesystem::path(path).parent_path() / scenario->robot);
  if (!robot) return tl::unexpected(robot.error());
  if (model_hash(**robot) != model_hash(*config.robot))
    return bad_input(path + ": its robot is another than the configuration's");
  Problems problems;
  auto machine =
      std::make_unique<Machine>(*scenario, std::move(*robot), config.plan.home, problems);
  if (problems.any()) return bad_input(problems);
  return machine;
}

std::string machine_truth(const Machine& machine) {
  nlohmann::ordered_json json, parameters = nlohmann::ordered_json::object();
  const std::vector<Parameter>& names = machine.robot().parameters();
  for (std::size_t i = 0; i < names.size(); ++i)
    parameters[names[i].name] = machine.truth().xi[static_cast<Eigen::Index>(i)];
  json["parameters"] = std::move(parameters);
  json["false_touches"] = machine.false_touches();
  json["visits"] = machine.visits();
  return json.dump(1) + "\n";
}

}  // namespace selfcal
