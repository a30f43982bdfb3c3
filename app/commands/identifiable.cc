// selfcal identifiable ROBOT --method METHOD: what a method can tell of a robot, on random
// configurations that satisfy it; selfcal identifiable DATASET: what the rows at hand can tell.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "app/commands/subcommand.h"
#include "app/commands/support/method_sets.h"
#include "app/report/format.h"
#include "app/report/progress_line.h"
#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "io/files/data_set_file.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

constexpr double kNegligible = 1e-4;  ///< of the largest coefficient of a group

struct IdentifiableArguments {
  std::string subject, method;
  MethodOptions options;
  bool json = false;
  int count = 120;
  unsigned long long seed = 1;
  std::string for_robots;  ///< an option given that says how configurations are drawn
};

struct Answered {
  std::shared_ptr<const Robot> robot;
  std::string method;
  int rows = 0, nuisance = 0;
  Identifiability rank;
  std::vector<Note> unexcited;
  std::vector<Lost> lost;
};

Result<Answered> of_robot(const IdentifiableArguments& arguments) {
  auto robot = load_robot(arguments.subject);
  if (!robot) return tl::unexpected(robot.error());
  const Result<std::vector<Set>> sets = method_sets(**robot, arguments.options, arguments.seed);
  if (!sets) return tl::unexpected(sets.error());
  const Result<std::vector<int>> held = held_joints(**robot, arguments.options);
  if (!held) return tl::unexpected(held.error());
  Answered answered;
  answered.method = arguments.method;
  answered.rows = arguments.count * static_cast<int>(sets->size());
  StructuralRank structure =
      structural(**robot, *sets, std::vector<char>((*robot)->parameters().size(), 1),
                 arguments.count, arguments.seed, {}, *held);
  if (!structure.unreached.empty())
    return tl::unexpected(Failure{kAnswerIsNo, structure.unreached});
  answered.rank = std::move(structure.rank);
  answered.nuisance = structure.nuisance;
  answered.lost = std::move(structure.lost);
  answered.robot = std::move(*robot);
  return answered;
}

Result<Answered> of_data_set(const IdentifiableArguments& arguments) {
  auto loaded = load_data_set(arguments.subject);
  if (!loaded) return tl::unexpected(loaded.error());
  print_notices(*loaded);
  Options options;
  options.gears = true;
  Solution solution;
  {
    ProgressLine line;
    solution = identify(*loaded->robot, loaded->data, options,
                        [&](std::string_view stage, double share) { line.show(stage, share); });
  }
  if (solution.sets.empty()) return tl::unexpected(Failure{kAnswerIsNo, solution.stop_reason});
  Answered answered;
  answered.unexcited = solution.unexcited;
  std::set<std::string> methods;
  for (const SetResult& set : solution.sets) {
    if (!set.identifies) continue;
    methods.insert(set.method);
    answered.rows += set.rows;
  }
  for (const std::string& method : methods)
    answered.method += (answered.method.empty() ? "" : ", ") + method;
  answered.nuisance = Equations(*loaded->robot, loaded->data, Use::fit).nuisance_dimensions();
  for (const ParameterResult& p : solution.parameters) {
    answered.rank.status.push_back(p.status);
    answered.rank.grouped_with.push_back(p.grouped_with);
  }
  answered.robot = std::move(loaded->robot);
  return answered;
}

nlohmann::ordered_json answered_json(const Answered& answered) {
  const Robot& robot = *answered.robot;
  nlohmann::ordered_json json{
      {"robot", robot.name()},          {"method", answered.method},
      {"rows", answered.rows},          {"candidates", robot.parameters().size()},
      {"total", answered.rank.total()}, {"own", answered.nuisance}};
  json["parameters"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    nlohmann::ordered_json carriers = nlohmann::ordered_json::array();
    for (const Carrier& c : answered.rank.grouped_with[i])
      carriers.push_back({{"name", c.name}, {"coefficient", c.coefficient}});
    json["parameters"].push_back({{"name", robot.parameters()[i].name},
                                  {"frame", robot.parameters()[i].frame},
                                  {"status", to_string(answered.rank.status[i])},
                                  {"grouped_with", carriers}});
  }
  if (!answered.lost.empty()) {
    json["lost"] = nlohmann::ordered_json::array();
    for (const Lost& lost : answered.lost)
      json["lost"].push_back(
          {{"count", lost.count}, {"why", lost.why}, {"parameters", lost.parameters}});
  }
  if (!answered.unexcited.empty()) {
    json["unexcited"] = nlohmann::ordered_json::array();
    for (const Note& note : answered.unexcited)
      json["unexcited"].push_back({{"parameter", note.parameter}, {"what", note.text}});
  }
  return json;
}

/// Those that a person needs: others are as good as nothing beside the largest.
std::vector<Carrier> worth_telling(std::vector<Carrier> carriers) {
  double most = 0;
  for (const Carrier& each : carriers) most = std::max(most, std::abs(each.coefficient));
  std::erase_if(carriers, [&](const Carrier& each) {
    return std::abs(each.coefficient) < kNegligible * most;
  });
  return carriers;
}

void print_answered(const Answered& answered) {
  const Robot& robot = *answered.robot;
  std::printf("%s by %s, %d rows: %d of %zu parameters identifiable, %d own unknowns\n",
              robot.name().c_str(), answered.method.c_str(), answered.rows, answered.rank.total(),
              robot.parameters().size(), answered.nuisance);
  int name_width = 0, full_width = 0;
  for (const Parameter& p : robot.parameters()) {
    name_width = std::max(name_width, characters(p.name));
    full_width = std::max(full_width, characters(p.frame + "." + p.field));
  }
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    std::string text = std::string(to_string(answered.rank.status[i]));
    const std::vector<Carrier> carriers = worth_telling(answered.rank.grouped_with[i]);
    for (size_t k = 0; k < carriers.size() && k < 4; ++k) {
      char each[80];
      std::snprintf(each, sizeof each, "%s%+.3g %s", k ? ", " : " with ", carriers[k].coefficient,
                    carriers[k].name.c_str());
      text += each;
    }
    const Parameter& p = robot.parameters()[i];
    std::printf("  %s  %s  %s%s\n", padded(p.name, name_width).c_str(),
                padded(p.frame + "." + p.field, full_width).c_str(), text.c_str(),
                carriers.size() > 4 ? ", …" : "");
  }
  for (const Lost& lost : answered.lost) {
    std::string names;
    for (const std::string& name : lost.parameters) names += (names.empty() ? " (" : " ") + name;
    std::printf("lost: %d: %s%s%s\n", lost.count, lost.why.c_str(), names.c_str(),
                names.empty() ? "" : ")");
  }
  for (const Note& note : answered.unexcited)
    std::printf("not excited: %s: %s\n", note.parameter.c_str(), note.text.c_str());
}

int identifiable_command(const IdentifiableArguments& arguments) {
  const bool is_robot = !arguments.method.empty();
  if (!std::filesystem::exists(arguments.subject))
    return tell({kBadInput, arguments.subject + ": no such file or folder"});
  const bool is_folder = std::filesystem::is_directory(arguments.subject) ||
                         std::filesystem::path(arguments.subject).filename() == "dataset.yaml";
  if (!is_robot && !is_folder)
    return wrong_usage("identifiable needs --method METHOD for a robot, or a data set's folder");
  if (is_robot && is_folder)
    return wrong_usage("--method goes with a robot file; a data set says its methods itself");
  if (is_folder && !arguments.for_robots.empty())
    return wrong_usage(arguments.for_robots +
                       " goes with a robot file and --method; a data set has its own rows");
  if (const std::string what = is_robot ? mistake(arguments.options) : ""; !what.empty())
    return wrong_usage(what);
  const auto answered = is_robot ? of_robot(arguments) : of_data_set(arguments);
  if (!answered) return tell(answered.error());
  if (arguments.json)
    std::printf("%s\n", answered_json(*answered).dump(1).c_str());
  else
    print_answered(*answered);
  return kDone;
}

}  // namespace

void add_identifiable(CLI::App& app, int& status) {
  auto arguments = std::make_shared<IdentifiableArguments>();
  CLI::App* command = app.add_subcommand(
      "identifiable", "Which parameters a method, or the rows of a data set, can tell");
  command->add_option("ROBOT|DATASET", arguments->subject, "Robot file, or folder of a data set")
      ->required();
  command->add_option("--method", arguments->method, "Constraint method (with a robot file)")
      ->check(is_method());
  std::vector<CLI::Option*> for_robots = add_lock_and_unknown(*command, arguments->options);
  for_robots.push_back(command->add_option("--count", arguments->count, "Random configurations")
                           ->check(CLI::Range(10, 100000))
                           ->capture_default_str());
  for_robots.push_back(command->add_option("--seed", arguments->seed, "Seed of the configurations")
                           ->capture_default_str());
  command->add_flag("--json", arguments->json, "Print JSON alone on standard output");
  command->callback([arguments, for_robots, &status] {
    for (const CLI::Option* option : for_robots)
      if (option->count() > 0) arguments->for_robots = option->get_name();
    if (!arguments->method.empty()) arguments->options.methods = {arguments->method};
    status = identifiable_command(*arguments);
  });
}

}  // namespace selfcal
