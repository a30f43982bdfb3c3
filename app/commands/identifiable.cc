// selfcal identifiable ROBOT --method METHOD: what a method can tell of a robot, on random
// configurations that satisfy it; selfcal identifiable DATASET: what the rows at hand can tell.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/commands/subcommand.h"
#include "app/report/progress_line.h"
#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "constraints/sampling/random_poses.h"
#include "io/files/data_set_file.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

struct IdentifiableArguments {
  std::string subject, method;
  std::vector<std::string> locks;  ///< "leg=1,joint=universal"
  bool unknown = false, json = false;
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

/// The entry of a set of `method`; planes are known, through the endpoint at a random
/// configuration, unless the user says otherwise; a link is as long as such a one asks for.
Node set_entry(const Robot& robot, const IdentifiableArguments& arguments) {
  Node node = Node::map();
  node.set("method", Node::of(arguments.method));
  if (arguments.unknown) return node;
  Eigen::Vector3d n(0.36, -0.48, 0.8);
  if (arguments.method == "plane-normal") node.set("normal", Node::of(Eigen::VectorXd(n)));
  if (arguments.method != "plane" && arguments.method != "constraint-link") return node;
  ConfigurationBlock block;
  block.q = random_poses(robot, nullptr, kLanes, arguments.seed).array();
  block.count = kLanes;
  Locations X;
  robot.locate(block, nominal_values(robot), Body::endpoint, X, nullptr);
  if (arguments.method == "constraint-link") return node.set("length", Node::of(X.p(0).norm()));
  int farthest = 0;  // a plane through the origin has no coefficients a b c
  for (int lane = 1; lane < kLanes; ++lane)
    if (std::abs(n.dot(X.p(lane))) > std::abs(n.dot(X.p(farthest)))) farthest = lane;
  node.set("plane", Node::of(Eigen::VectorXd(-n / (0.6 * n.dot(X.p(farthest))))));
  return node;
}

/// An entry of a set for each lock, of the words KEY=VALUE between commas.
std::vector<Set> locked_sets(const std::vector<std::string>& locks, Problems& problems) {
  std::vector<Set> sets;
  for (const std::string& lock : locks) {
    const Place option{std::make_shared<const std::string>("--lock " + lock)};
    Node words = Node::map();
    words.place = option;
    std::istringstream text(lock);
    for (std::string word; std::getline(text, word, ',');) {
      const size_t equals = word.find('=');
      Node value = Node::of(equals == std::string::npos ? std::string() : word.substr(equals + 1));
      value.place = option;
      words.set(word.substr(0, equals), std::move(value));
    }
    Node node = Node::map();
    node.place = option;
    node.set("method", Node::of(std::string("locked-joint"))).set("lock", std::move(words));
    sets.push_back(make_set(lock, node, problems));
  }
  return sets;
}

/// The joints, read ones, that `--lock joint=NAME` holds while the others move.
std::vector<int> held_joints(const Robot& robot, const std::vector<std::string>& locks,
                             Problems& problems) {
  std::vector<int> held;
  for (const std::string& lock : locks) {
    const std::string key = "joint=";
    const int joint = lock.starts_with(key) ? find_joint(robot, lock.substr(key.size())) : -1;
    if (joint < 0)
      problems.list.push_back("--lock " + lock + ": expected joint=NAME of " + robot.name() +
                              ", such as joint=" + robot.joints().front().name);
    held.push_back(joint);
  }
  return held;
}

Result<Answered> of_robot(const IdentifiableArguments& arguments) {
  auto robot = load_robot(arguments.subject);
  if (!robot) return tl::unexpected(robot.error());
  Problems problems;
  std::vector<Set> sets;
  std::vector<int> held;
  if (arguments.method == "locked-joint") {
    sets = locked_sets(arguments.locks, problems);
  } else {
    sets.push_back(make_set(arguments.method, set_entry(**robot, arguments), problems));
    held = held_joints(**robot, arguments.locks, problems);
  }
  if (problems.any()) return tl::unexpected(Failure{kWrongUsage, problems.list.front()});
  if (const std::string why = lacking_body(**robot, sets); !why.empty())
    return tl::unexpected(Failure{kWrongUsage, why});
  Answered answered;
  answered.method = arguments.method;
  answered.rows = arguments.count * static_cast<int>(sets.size());
  StructuralRank structure =
      structural(**robot, sets, std::vector<char>((*robot)->parameters().size(), 1),
                 arguments.count, arguments.seed, {}, held);
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

void print_answered(const Answered& answered) {
  const Robot& robot = *answered.robot;
  std::printf("%s by %s, %d rows: %d of %zu parameters identifiable, %d own unknowns\n",
              robot.name().c_str(), answered.method.c_str(), answered.rows, answered.rank.total(),
              robot.parameters().size(), answered.nuisance);
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    std::string text = std::string(to_string(answered.rank.status[i]));
    const auto& carriers = answered.rank.grouped_with[i];
    for (size_t k = 0; k < carriers.size() && k < 4; ++k) {
      char each[80];
      std::snprintf(each, sizeof each, "%s%+.3g %s", k ? ", " : " with ", carriers[k].coefficient,
                    carriers[k].name.c_str());
      text += each;
    }
    const Parameter& p = robot.parameters()[i];
    std::printf("  %-8s %-24s %s%s\n", p.name.c_str(), (p.frame + "." + p.field).c_str(),
                text.c_str(), carriers.size() > 4 ? ", …" : "");
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
  if (arguments.unknown && !arguments.method.starts_with("plane"))
    return wrong_usage("--unknown goes with plane and plane-normal, not with " + arguments.method);
  if (arguments.method == "locked-joint" && arguments.locks.empty())
    return wrong_usage("--method locked-joint needs --lock leg=N,joint=universal or spherical");
  const auto answered = is_robot ? of_robot(arguments) : of_data_set(arguments);
  if (!answered) return tell(answered.error());
  if (arguments.json)
    std::printf("%s\n", answered_json(*answered).dump(1).c_str());
  else
    print_answered(*answered);
  return kDone;
}

std::vector<std::string> method_list() {
  const std::vector<std::string_view> names = method_names();
  return {names.begin(), names.end()};
}

}  // namespace

void add_identifiable(CLI::App& app, int& status) {
  auto arguments = std::make_shared<IdentifiableArguments>();
  CLI::App* command = app.add_subcommand(
      "identifiable", "Which parameters a method, or the rows of a data set, can tell");
  command->add_option("ROBOT|DATASET", arguments->subject, "Robot file, or folder of a data set")
      ->required();
  command->add_option("--method", arguments->method, "Constraint method (with a robot file)")
      ->check(CLI::IsMember(method_list()));
  const std::vector<CLI::Option*> for_robots = {
      command
          ->add_option("--lock", arguments->locks,
                       "Of locked-joint leg=N,joint=universal or spherical, again for each that is "
                       "locked in turn; of others joint=NAME, held while the others move")
          ->expected(1)
          ->take_all(),
      command->add_flag("--unknown", arguments->unknown, "The plane is unknown"),
      command->add_option("--count", arguments->count, "Random configurations")
          ->check(CLI::Range(10, 100000))
          ->capture_default_str(),
      command->add_option("--seed", arguments->seed, "Seed of the configurations")
          ->capture_default_str()};
  command->add_flag("--json", arguments->json, "Print JSON alone on standard output");
  command->callback([arguments, for_robots, &status] {
    for (const CLI::Option* option : for_robots)
      if (option->count() > 0) arguments->for_robots = option->get_name();
    status = identifiable_command(*arguments);
  });
}

}  // namespace selfcal
