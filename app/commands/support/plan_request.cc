#include "app/commands/support/plan_request.h"

#include "app/commands/support/prior_file.h"
#include "io/files/observations_csv.h"

namespace selfcal {
namespace {

constexpr int kFurtherCandidates = 60;                // of each set, where further places are tried
constexpr double kTurnSpeed = 1, kSlideSpeed = 0.25;  // rad/s, m/s, where none is given

/// By joint; nothing where there are neither none, one nor one for each joint.
std::optional<Eigen::VectorXd> speeds(const Robot& robot, const std::vector<double>& given) {
  const std::vector<Joint>& joints = robot.joints();
  if (given.size() > 1 && given.size() != joints.size()) return std::nullopt;
  Eigen::VectorXd speed(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t j = 0; j < joints.size(); ++j)
    speed[static_cast<Eigen::Index>(j)] =
        given.empty() ? (joints[j].quantity == Quantity::angle ? kTurnSpeed : kSlideSpeed)
                      : given[given.size() == 1 ? 0 : j];
  return speed;
}

Workspace workspace_of(const std::vector<double>& corners) {
  Workspace workspace;
  if (corners.empty()) return workspace;
  const Eigen::Map<const Eigen::Vector3d> a(corners.data()), b(corners.data() + 3);
  workspace.box = Eigen::AlignedBox3d(a.cwiseMin(b), a.cwiseMax(b));
  return workspace;
}

}  // namespace

Result<PlanRequest> plan_request(const Robot& robot, const PlanArguments& arguments) {
  PlanRequest request;
  auto sets = method_sets(robot, arguments.options, arguments.seed);
  if (!sets) return tl::unexpected(sets.error());
  request.pool.sets = *std::move(sets);
  if (!arguments.start.empty()) {
    request.pool.taken.sets = request.pool.sets;
    if (const auto read = read_configurations(arguments.start, robot, request.pool.taken); !read)
      return tl::unexpected(read.error());
    request.pool.sets = request.pool.taken.sets;  // with the names of the groups
  }
  const auto speed = speeds(robot, arguments.speed);
  if (!speed)
    return tl::unexpected(Failure{kWrongUsage, "--speed takes one number, or one for each of the " +
                                                   std::to_string(robot.joints().size()) +
                                                   " joints"});
  request.speed = *speed;
  const Result<std::vector<int>> held = held_joints(robot, arguments.options);
  if (!held) return tl::unexpected(held.error());
  request.pool.held = *held;
  if (!arguments.prior.empty()) {
    const auto prior = read_prior(arguments.prior, robot);
    if (!prior) return tl::unexpected(prior.error());
    request.pool.prior = *prior;
  }
  request.count = arguments.count;
  request.pool.spacing = arguments.spacing;
  request.longest = arguments.longest;
  request.pool.candidates = arguments.candidates;
  request.pool.groups = arguments.groups;
  request.pool.seed = arguments.seed;
  request.criterion = *criterion_of(arguments.criterion);
  request.workspace = workspace_of(arguments.workspace);
  return request;
}

Result<NextRequest> next_request(const Robot& robot, const PlanArguments& arguments,
                                 DataSet planned) {
  NextRequest next;
  Problems problems;
  next.further =
      make_set("further", Node::map().set("method", Node::of(arguments.further)), problems);
  if (!problems.any() && has_body(robot, next.further.method->body()) == false)
    problems.list.push_back("--further " + arguments.further + ": not of this robot");
  if (problems.any()) return tl::unexpected(Failure{kWrongUsage, problems.list.front()});
  next.further.noise = arguments.options.noise;
  next.further.noise_angle = arguments.options.noise_angle;
  next.pool.sets = planned.sets;
  next.pool.taken = std::move(planned);
  next.pool.candidates = kFurtherCandidates * static_cast<int>(next.pool.sets.size());
  next.pool.groups = arguments.groups;
  next.pool.seed = arguments.seed;
  return next;
}

}  // namespace selfcal
