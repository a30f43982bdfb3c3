#include "app/commands/support/method_sets.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include "constraints/methods/shared/unit_normal.h"
#include "constraints/sampling/random_poses.h"

namespace selfcal {
namespace {

const char* const kLocked = "locked-joint";
const char* const kCircles = "circle-point";

bool locks_legs(const MethodOptions& options) {
  return std::ranges::count(options.methods, kLocked) > 0;
}

/// The endpoint at random configurations, lane by lane.
Locations somewhere(const Robot& robot, unsigned long long seed) {
  ConfigurationBlock block;
  block.q = random_poses(robot, nullptr, kLanes, seed).array();
  block.count = kLanes;
  Locations X;
  robot.locate(block, nominal_values(robot), Body::endpoint, X, nullptr);
  return X;
}

/// Coefficients of a plane with normal `n` that cuts the reach of the endpoint, wherever the robot
/// stands: between the middle of random configurations and the farther end from the world's origin,
/// which no plane with coefficients a b c goes through.
Eigen::Vector3d plane_through(const Robot& robot, const Eigen::Vector3d& n,
                              unsigned long long seed) {
  const Locations X = somewhere(robot, seed);
  Eigen::VectorXd along(kLanes);
  for (int lane = 0; lane < kLanes; ++lane) along[lane] = n.dot(X.p(lane));
  const double middle = along.mean();
  const double end = middle > 0 ? along.maxCoeff() : along.minCoeff();
  return -n / (middle + 0.6 * (end - middle));
}

Node with_noise(Node node, const MethodOptions& options) {
  if (options.noise > 0) node.set("noise", Node::of(options.noise));
  if (options.noise_angle > 0) node.set("noise_angle", Node::of(options.noise_angle));
  return node;
}

/// The entry of the `place`-th set.
Node set_entry(const Robot& robot, const MethodOptions& options, std::size_t place,
               unsigned long long seed) {
  const std::string& method = options.methods[place];
  Node node = Node::map();
  node.set("method", Node::of(method));
  if (options.unknown) return with_noise(std::move(node), options);
  Random random(place);
  const Eigen::Vector3d n =
      place == 0 ? Eigen::Vector3d(0.36, -0.48, 0.8) : random_direction(random);
  if (method == "plane-normal") node.set("normal", Node::of(Eigen::VectorXd(n)));
  if (method == "plane")
    node.set("plane", Node::of(Eigen::VectorXd(plane_through(robot, n, seed))));
  if (method == "constraint-link") node.set("length", Node::of(somewhere(robot, seed).p(0).norm()));
  return with_noise(std::move(node), options);
}

Set locked_set(const std::string& lock, const MethodOptions& options, Problems& problems) {
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
  node.set("method", Node::of(std::string(kLocked))).set("lock", std::move(words));
  return make_set(lock, with_noise(std::move(node), options), problems);
}

/// A set of circle points for each joint that turns.
std::vector<Set> circle_sets(const Robot& robot, const MethodOptions& options, Problems& problems) {
  std::vector<Set> sets;
  for (const Joint& joint : robot.joints()) {
    if (joint.quantity != Quantity::angle) continue;
    Node node = Node::map();
    node.set("method", Node::of(std::string(kCircles))).set("joint", Node::of(joint.name));
    sets.push_back(make_set(joint.name, with_noise(std::move(node), options), problems));
  }
  return sets;
}

}  // namespace

CLI::IsMember is_method() {
  const std::vector<std::string_view> names = method_names();
  return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}

std::vector<CLI::Option*> add_lock_and_unknown(CLI::App& command, MethodOptions& options) {
  return {command
              .add_option("--lock", options.locks,
                          "Of locked-joint leg=N,joint=universal or spherical, again for each that "
                          "is locked in turn; of others joint=NAME, held while the others move")
              ->expected(1)
              ->take_all(),
          command.add_flag("--unknown", options.unknown, "The plane is unknown")};
}

std::string mistake(const MethodOptions& options) {
  const bool planes = std::ranges::any_of(
      options.methods, [](const std::string& each) { return each.starts_with("plane"); });
  if (options.unknown && !planes)
    return "--unknown goes with plane and plane-normal, not with " + options.methods.front();
  if (locks_legs(options) && options.locks.empty())
    return "--method locked-joint needs --lock leg=N,joint=universal or spherical";
  return {};
}

Result<std::vector<int>> held_joints(const Robot& robot, const MethodOptions& options) {
  std::vector<int> held;
  if (locks_legs(options)) return held;
  for (const std::string& lock : options.locks) {
    const std::string key = "joint=";
    const int joint = lock.starts_with(key) ? find_joint(robot, lock.substr(key.size())) : -1;
    if (joint < 0)
      return tl::unexpected(
          Failure{kWrongUsage, "--lock " + lock + ": expected joint=NAME of " + robot.name() +
                                   ", such as joint=" + robot.joints().front().name});
    held.push_back(joint);
  }
  return held;
}

Result<std::vector<Set>> method_sets(const Robot& robot, const MethodOptions& options,
                                     unsigned long long seed) {
  Problems problems;
  std::vector<Set> sets;
  for (std::size_t i = 0; i < options.methods.size(); ++i) {
    const std::string& method = options.methods[i];
    if (method == kLocked) {
      for (const std::string& lock : options.locks)
        sets.push_back(locked_set(lock, options, problems));
      continue;
    }
    if (method == kCircles) {
      for (Set& set : circle_sets(robot, options, problems)) sets.push_back(std::move(set));
      continue;
    }
    const auto before = std::count(
        options.methods.begin(), options.methods.begin() + static_cast<std::ptrdiff_t>(i), method);
    sets.push_back(make_set(before == 0 ? method : method + std::to_string(before + 1),
                            set_entry(robot, options, i, seed + i), problems));
  }
  if (problems.any()) return tl::unexpected(Failure{kWrongUsage, problems.list.front()});
  if (const std::string why = lacking_body(robot, sets); !why.empty())
    return tl::unexpected(Failure{kWrongUsage, why});
  return sets;
}

}  // namespace selfcal
