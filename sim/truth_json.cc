// One function for each part of the truth, in the order of the file.
#include "sim/truth_json.h"

namespace selfcal {
namespace {

using Json = nlohmann::ordered_json;

Json by_name(const Robot& robot, const Eigen::VectorXd& values) {
  Json json = Json::object();
  for (Eigen::Index i = 0; i < values.size(); ++i) json[robot.parameters()[i].name] = values[i];
  return json;
}

Json by_name(const std::vector<NamedNumber>& list) {
  Json json = Json::object();
  for (const NamedNumber& each : list) json[each.name] = each.value;
  return json;
}

Json own_values(const Simulated& made, std::size_t s) {
  const Set& set = made.data.sets[s];
  const Eigen::VectorXd* reference =
      set.reference < 0 ? nullptr : &made.truth.nuisance[set.reference];
  Json json = Json::object();
  for (const NuisanceReport& report : set.method->report(made.truth.nuisance[s], reference))
    json[set.name + "." + report.name] = report.value;
  const std::vector<std::string> names = set.method->group_names();
  const Eigen::MatrixXd& groups = made.truth.groups[s];
  for (Eigen::Index g = 0; g < groups.cols(); ++g)
    for (std::size_t i = 0; i < names.size(); ++i)
      json[set.name + "." + set.groups[g] + "." + names[i]] =
          groups(static_cast<Eigen::Index>(i), g);
  return json;
}

Json sets(const Scenario& scenario, const Simulated& made) {
  Json list = Json::array();
  for (std::size_t s = 0; s < made.data.sets.size(); ++s)
    list.push_back({{"name", made.data.sets[s].name},
                    {"method", made.data.sets[s].method->name()},
                    {"noise", scenario.sets[s].noise},
                    {"noise_angle", scenario.sets[s].noise_angle},
                    {"own", own_values(made, s)}});
  return list;
}

}  // namespace

Json truth_json(const Scenario& scenario, const Robot& robot, const Simulated& made) {
  Json false_rows = Json::array();
  for (const int row : made.false_rows) false_rows.push_back(row + 1);
  return Json::object({{"robot", robot.name()},
                       {"seed", scenario.seed},
                       {"parameters", by_name(robot, made.truth.xi)},
                       {"errors", by_name(robot, made.truth.xi - values(robot))},
                       {"sets", sets(scenario, made)},
                       {"false_rows", std::move(false_rows)},
                       {"encoder_step", scenario.encoder_step},
                       {"compliance", by_name(scenario.compliance)}});
}

}  // namespace selfcal
