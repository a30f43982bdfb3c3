#include "constraints/planning/touch_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/methods/plane.h"
#include "constraints/methods/unit_normal.h"
#include "constraints/planning/d_optimal.h"
#include "constraints/sampling/contact.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"

namespace selfcal {
namespace {

constexpr int kCandidatesEach = 4;  // sampled for each touch that is asked for
constexpr int kPathBlocks = 3;      // of kLanes places along a path
constexpr int kPoses = 500;         // at which the end position is judged
constexpr unsigned long long kSeed = 1;
constexpr int kRounds = 12;  // of sampling, until enough candidates are usable

/// Distance of two configurations, each joint counted against its range.
double distance(const Robot& robot, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    sum += std::pow((a[j] - b[j]) / robot.joints()[j].range(), 2);
  }
  return std::sqrt(sum);
}

/// Candidates of one target with their way in, as far as they are usable.
class Candidates {
 public:
  Candidates(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
             const std::vector<Obstacle>& obstacles, const TouchPlanOptions& options)
      : robot_(robot), xi_(xi), sets_(sets), obstacles_(obstacles), options_(options) {}

  /// `tell` hears of the share of the wanted ones that is found.
  std::vector<PlannedTouch> of(const TouchTarget& target, int obstacle, Random& random,
                               const std::function<void(double)>& tell) const {
    std::vector<PlannedTouch> usable;
    const int wanted = kCandidatesEach * target.touches;
    for (int round = 0; round < kRounds && static_cast<int>(usable.size()) < wanted; ++round) {
      tell(static_cast<double>(usable.size()) / wanted);
      sample(target, obstacle, random, usable);
    }
    return usable;
  }

 private:
  void sample(const TouchTarget& target, int obstacle, Random& random,
              std::vector<PlannedTouch>& usable) const {
    const int rows = kCandidatesEach * target.touches;
    DataSet data;
    data.sets = {sets_[target.set]};
    // The nominal surface is given whole, whatever the set knows or shares of it.
    if (target.plane) data.sets[0].method = point_on_plane();
    data.sets[0].reference = -1;
    SampleRequest request;
    request.rows = rows;
    request.together = target.places.empty();
    request.rows_per_group =
        std::max<int>(1, rows / std::max<int>(1, static_cast<int>(target.places.size())));
    if (target.plane) request.nuisance = data.sets[0].method->nuisance_of(*target.plane);
    if (locks(target.set)) {
      Location engaged;
      engaged.R << tangents(target.outward), target.outward;
      request.nuisance = data.sets[0].method->through(engaged, nullptr, random);
    }
    request.patch = target.within;
    request.places = target.places;
    const Sampled sampled = sample_rows(robot_, xi_, {request}, random, data);
    for (int row = 0; row < data.rows.rows(); ++row) {
      const int group = data.rows.group[row];
      if (group >= static_cast<int>(target.places.size()) && !target.places.empty()) continue;
      PlannedTouch touch;
      touch.set = target.set;
      touch.group = group;
      touch.touch = data.rows.q.row(row).transpose();
      if (enter(target, obstacle, data, sampled.truth, row, touch)) usable.push_back(touch);
    }
  }

  /// Fills in where the touch begins and where it is given up.
  bool enter(const TouchTarget& target, int obstacle, const DataSet& data, const State& truth,
             int row, PlannedTouch& touch) const {
    if (locks(target.set)) {
      touch.start = touch.end = touch.touch;
      return within_limits(robot_, touch.touch, options_.limit_margin) &&
             path_is_free(robot_, xi_, options_.home, touch.touch, obstacles_, options_.apart);
    }
    const Location X = locate(robot_, xi_, touch.touch);
    if ((X.R * robot_.tool_axis()).dot(-target.outward) < std::cos(options_.tilt)) return false;
    touch.start = touch.end = touch.touch;
    if (!move_out(target, data, truth, row, options_.clearance, touch.start)) return false;
    if (!target.places.empty())
      touch.end = touch.touch;
    else if (!move_out(target, data, truth, row, -options_.search, touch.end))
      return false;
    return within_limits(robot_, touch.start, options_.limit_margin) &&
           within_limits(robot_, touch.end, options_.limit_margin) &&
           path_is_free(robot_, xi_, touch.start, touch.end, obstacles_, options_.apart,
                        obstacle) &&
           path_is_free(robot_, xi_, options_.home, touch.start, obstacles_, options_.apart);
  }

  /// Moves `q` by `distance` along the way out, the endpoint's orientation as it comes.
  bool move_out(const TouchTarget& target, const DataSet& data, const State& truth, int row,
                double distance, Eigen::VectorXd& q) const {
    const Method& method = *data.sets[0].method;
    Eigen::VectorXd wanted =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(method.equations().size()));
    if (const auto plane = method.plane(truth.nuisance[0], nullptr))
      wanted[0] = distance * plane->n.dot(target.outward);
    else
      wanted.head<3>() = distance * target.outward;
    return move_to_residual(robot_, data, truth, row, wanted, q);
  }

  bool locks(int set) const { return sets_[set].method->planned() == Planned::lock; }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const std::vector<Set>& sets_;
  const std::vector<Obstacle>& obstacles_;
  const TouchPlanOptions& options_;
};

/// Those of the usable touches that tell most together, as many of each set as are asked for.
std::vector<PlannedTouch> choose(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<TouchTarget>& targets,
                                 const std::vector<std::vector<PlannedTouch>>& usable) {
  std::vector<PossibleTouch> candidates;
  std::vector<const PlannedTouch*> touches;
  std::vector<int> counts(sets.size(), 0);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    counts[targets[t].set] = targets[t].touches;
    for (const PlannedTouch& each : usable[t]) {
      candidates.push_back({each.touch, each.set, each.group, targets[t].outward});
      touches.push_back(&each);
    }
  }
  std::vector<PlannedTouch> chosen;
  for (const int i : d_optimal_touches(robot, xi, sets, candidates, std::move(counts)))
    chosen.push_back(*touches[i]);
  return chosen;
}

/// Every third or so of each set, evenly over the order of choice.
void mark_check(std::vector<PlannedTouch>& touches, std::size_t sets, double share) {
  std::vector<int> seen(sets, 0);
  for (PlannedTouch& touch : touches) {
    const int i = seen[touch.set]++;
    touch.check = std::floor(share * (i + 1)) > std::floor(share * i);
  }
}

/// The touches of each target in an order of short ways, begun at home; a touch that can be
/// reached neither directly nor through home is left out.
std::vector<PlannedTouch> order(const Robot& robot, const Eigen::VectorXd& xi,
                                const std::vector<Set>& sets, std::vector<PlannedTouch> touches,
                                const std::vector<Obstacle>& obstacles,
                                const TouchPlanOptions& options) {
  std::vector<PlannedTouch> path;
  Eigen::VectorXd here = options.home;
  while (!touches.empty()) {
    const auto nearest = std::ranges::min_element(touches, {}, [&](const PlannedTouch& each) {
      // A set is finished before the next is begun.
      const bool other = !path.empty() && each.set != path.back().set;
      return distance(robot, here, each.start) + (other ? 1e3 : 0);
    });
    PlannedTouch next = std::move(*nearest);
    touches.erase(nearest);
    next.via_home = !path_is_free(robot, xi, here, next.start, obstacles, options.apart);
    // A lock stays engaged from its first configuration to its last.
    const bool held = !path.empty() && path.back().set == next.set &&
                      sets[next.set].method->planned() == Planned::lock;
    if (next.via_home && held) continue;
    if (next.via_home &&
        (!path_is_free(robot, xi, here, options.home, obstacles, options.apart) ||
         !path_is_free(robot, xi, options.home, next.start, obstacles, options.apart)))
      continue;
    here = next.start;
    path.push_back(std::move(next));
  }
  return path;
}

}  // namespace

bool path_is_free(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const std::vector<Obstacle>& obstacles, double apart,
                  int touched) {
  const auto blocked = [&](const Eigen::Vector3d& p) {
    for (std::size_t o = 0; o < obstacles.size(); ++o) {
      const Obstacle& each = obstacles[o];
      if (static_cast<int>(o) == touched) continue;
      const bool near =
          each.within.radius <= 0 || (p - each.within.centre).norm() <= each.within.radius + apart;
      if (near && each.outward.dot(p - each.point) < apart) return true;
    }
    return false;
  };
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, from.size()), kLanes};
  Locations X;
  for (int part = 0; part < kPathBlocks; ++part) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double s = (part * kLanes + lane) / (kPathBlocks * kLanes - 1.0);
      block.q.row(lane) = (from + s * (to - from)).transpose().array();
    }
    if (!robot.locate(block, xi, Body::endpoint, X, nullptr).closes()) return false;
    for (int lane = 0; lane < kLanes; ++lane)
      if (blocked(X.p(lane))) return false;
  }
  return true;
}

TouchPlan plan_touches(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
                       const std::vector<TouchTarget>& targets,
                       const std::vector<Obstacle>& obstacles, const TouchPlanOptions& options,
                       const Progress& progress) {
  const auto tell = [&](const char* stage, double share) {
    if (progress) progress(stage, share);
  };
  TouchPlan plan;
  const Candidates candidates(robot, xi, sets, obstacles, options);
  Random random(options.seed);
  std::vector<std::vector<PlannedTouch>> usable;
  for (const TouchTarget& target : targets) {
    const auto before = static_cast<double>(usable.size());
    usable.push_back(candidates.of(target, target.obstacle, random, [&](double share) {
      tell("looking for touches", (before + share) / static_cast<double>(targets.size()));
    }));
    const auto found = static_cast<int>(usable.back().size());
    if (found < target.touches && plan.unreached.empty())
      plan.unreached = "set " + sets[target.set].name + ": only " + std::to_string(found) + " of " +
                       std::to_string(target.touches) +
                       " touches are within the joint limits, the tilt and reach of home";
  }
  tell("choosing touches", 0);
  std::vector<PlannedTouch> chosen = choose(robot, xi, sets, targets, usable);
  mark_check(chosen, sets.size(), options.check);
  tell("ordering touches", 0);
  plan.touches = order(robot, xi, sets, std::move(chosen), obstacles, options);
  return plan;
}

ExpectedSigma expected_sigma(const Robot& robot, const Eigen::VectorXd& xi,
                             const std::vector<Set>& sets, const std::vector<TouchTarget>& targets,
                             const TouchPlan& plan, const Workspace& workspace) {
  std::vector<PossibleTouch> touches;
  for (const TouchTarget& target : targets)
    for (const PlannedTouch& each : plan.touches)
      if (each.set == target.set && !each.check)
        touches.push_back({each.touch, each.set, each.group, target.outward});
  EndpointQuestion question;
  question.robot = &robot;
  question.xi = xi;
  question.covariance = covariance_after(robot, xi, sets, touches);
  question.unseen = Eigen::MatrixXd::Identity(6, 6);
  question.poses = random_poses(robot, nullptr, kPoses, kSeed);
  ExpectedSigma expected;
  expected.endpoint = endpoint_sigma(question);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(touches.size()), question.poses.cols());
  for (std::size_t i = 0; i < touches.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = touches[i].q.transpose();
  question.poses = workspace_poses(robot, xi, workspace, rows, kPoses, kSeed);
  expected.workspace = endpoint_sigma(question);
  return expected;
}

}  // namespace selfcal
