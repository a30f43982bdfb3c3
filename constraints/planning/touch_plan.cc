#include "constraints/planning/touch_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/methods/shared/shared_point.h"
#include "constraints/methods/shared/unit_normal.h"
#include "constraints/planning/touch_choice.h"
#include "constraints/planning/tour.h"
#include "constraints/sampling/contact.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"

namespace selfcal {
namespace {

constexpr int kCandidatesEach = 4;  // sampled for each touch that is asked for
constexpr int kPostures = 4;        // of the robot at one point of a surface
constexpr int kPointTries = 2;      // blocks of starts before a point of a surface is given up
constexpr int kPoses = 500;         // at which the end position is judged
constexpr unsigned long long kSeed = 1;
constexpr double kEdge = 0.02;     // of a patch, kept free at its edge
constexpr int kRounds = 24;        // of sampling, until enough candidates are usable
constexpr std::size_t kNear = 12;  // touches to which a free way is looked for
constexpr double kOtherSet = 1e4;  // s, that no order gains by leaving a set unfinished

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
    SampleRequest request;
    request.together = target.places.empty();
    if (target.plane) {
      request.rows = request.rows_per_group = kPostures;
      request.tries = kPointTries;
      for (int point = 0; point < rows; point += kPostures) {
        request.places = {{Eigen::Matrix3d::Identity(), point_of(target, random)}};
        take(target, obstacle, shared_point(), request, random, usable);
      }
      return;
    }
    const std::shared_ptr<const Method>& method = sets_[target.set].method;
    request.rows = rows;
    request.rows_per_group =
        std::max<int>(1, rows / std::max<int>(1, static_cast<int>(target.places.size())));
    if (locks(target.set)) {
      Location engaged;
      engaged.R << tangents(target.outward), target.outward;
      request.nuisance = method->through(engaged, nullptr, random);
    }
    request.patch = target.within;
    request.places = target.places;
    take(target, obstacle, method, request, random, usable);
  }

  /// Anywhere on the nominal surface within its patch, but at its edge, which a touch may miss (m).
  Eigen::Vector3d point_of(const TouchTarget& target, Random& random) const {
    const Plane& plane = *target.plane;
    const double off = plane.d.value() - plane.n.dot(target.within.centre);
    const double all =
        std::sqrt(std::max(0.0, target.within.radius * target.within.radius - off * off));
    const double radius = (1 - kEdge) * all;
    std::uniform_real_distribution<double> uniform;
    const double away = radius * std::sqrt(uniform(random)), turn = 2 * M_PI * uniform(random);
    return target.within.centre + off * plane.n +
           away * (tangents(plane.n) * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
  }

  /// Those of the sampled configurations that are usable.
  void take(const TouchTarget& target, int obstacle, const std::shared_ptr<const Method>& method,
            const SampleRequest& request, Random& random, std::vector<PlannedTouch>& usable) const {
    DataSet data;
    data.sets = {sets_[target.set]};
    data.sets[0].method = method;
    data.sets[0].reference = -1;
    const Sampled sampled = sample_rows(robot_, xi_, {request}, random, data);
    for (int row = 0; row < data.rows.rows(); ++row) {
      const int group = data.rows.group[row];
      if (group >= static_cast<int>(request.places.size()) && !request.places.empty()) continue;
      PlannedTouch touch;
      touch.set = target.set;
      touch.group = target.places.empty() ? -1 : group;
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

/// Those of the usable touches that tell most together, as many of each set as are asked for; a
/// share of them, drawn from the rest, is kept aside to judge.
std::vector<PlannedTouch> choose(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<TouchTarget>& targets,
                                 const std::vector<std::vector<PlannedTouch>>& usable,
                                 const Workspace& workspace, double share, Random& random,
                                 const Progress& progress) {
  std::vector<PossibleTouch> candidates;
  std::vector<PlannedTouch> touches;
  TouchCounts counts{std::vector<int>(sets.size(), 0), std::vector<int>(sets.size(), 0)};
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const int set = targets[t].set, kept = static_cast<int>(share * targets[t].touches);
    counts.check[set] = kept;
    counts.fit[set] = targets[t].touches - kept;
    for (const PlannedTouch& each : usable[t]) {
      candidates.push_back({each.touch, each.set, each.group, targets[t].outward});
      touches.push_back(each);
    }
  }
  const TouchChoice choice =
      choose_touches(robot, xi, sets, candidates, counts, workspace, random, progress);
  std::vector<PlannedTouch> chosen;
  for (const int i : choice.fit) chosen.push_back(touches[i]);
  for (const int i : choice.check) {
    chosen.push_back(touches[i]);
    chosen.back().check = true;
  }
  return chosen;
}

/// Time (s) from each of home and the touches to each other: of a free way where they are near,
/// through home else.
Eigen::MatrixXd times_between(const Surroundings& cell, const std::vector<PlannedTouch>& touches) {
  std::vector<const Eigen::VectorXd*> places{&cell.home};
  for (const PlannedTouch& each : touches) places.push_back(&each.start);
  const auto count = static_cast<Eigen::Index>(places.size());
  const Eigen::VectorXd speed = Eigen::VectorXd::Constant(cell.home.size(), cell.speed);
  Eigen::MatrixXd straight(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      straight(a, b) = joint_time(*places[static_cast<std::size_t>(a)],
                                  *places[static_cast<std::size_t>(b)], speed);
  Eigen::MatrixXd time = straight.col(0).replicate(1, count) + straight.row(0).replicate(count, 1);
  std::vector<Eigen::Index> near(places.size());
  for (Eigen::Index a = 1; a < count; ++a) {
    std::iota(near.begin(), near.end(), 0);
    const std::size_t some = std::min(near.size(), kNear + 1);
    std::partial_sort(
        near.begin(), near.begin() + static_cast<std::ptrdiff_t>(some), near.end(),
        [&](Eigen::Index b, Eigen::Index c) { return straight(a, b) < straight(a, c); });
    for (std::size_t i = 0; i < some; ++i) {
      const Eigen::Index b = near[i];
      if (b == 0 || b == a) continue;
      time(a, b) = time(b, a) =
          free_way(cell, *places[static_cast<std::size_t>(a)], *places[static_cast<std::size_t>(b)])
              .time;
    }
  }
  for (std::size_t a = 0; a < touches.size(); ++a)
    for (std::size_t b = 0; b < touches.size(); ++b)
      if (touches[a].set != touches[b].set)
        time(static_cast<Eigen::Index>(a) + 1, static_cast<Eigen::Index>(b) + 1) += kOtherSet;
  return time;
}

}  // namespace

std::vector<PlannedTouch> in_short_order(const Surroundings& cell, const std::vector<Set>& sets,
                                         const std::vector<PlannedTouch>& touches) {
  std::vector<PlannedTouch> path;
  for (const int place : short_tour_from_first(times_between(cell, touches))) {
    if (place == 0) continue;
    PlannedTouch next = touches[static_cast<std::size_t>(place) - 1];
    const FreeWay way = free_way(cell, path.empty() ? cell.home : path.back().start, next.start);
    next.via_home = way.via_home;
    next.way = way.through;
    // A lock stays engaged from its first configuration to its last.
    const bool held = !path.empty() && path.back().set == next.set &&
                      sets[static_cast<std::size_t>(next.set)].method->planned() == Planned::lock;
    if (held && (next.via_home || !next.way.empty())) continue;
    path.push_back(std::move(next));
  }
  return path;
}

std::vector<std::vector<PlannedTouch>> usable_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                                      const std::vector<Set>& sets,
                                                      const std::vector<TouchTarget>& targets,
                                                      const std::vector<Obstacle>& obstacles,
                                                      const TouchPlanOptions& options,
                                                      Random& random, const Progress& progress) {
  const Candidates candidates(robot, xi, sets, obstacles, options);
  std::vector<std::vector<PlannedTouch>> usable;
  for (const TouchTarget& target : targets) {
    const auto before = static_cast<double>(usable.size());
    usable.push_back(candidates.of(target, target.obstacle, random, [&](double share) {
      if (progress)
        progress("looking for touches", (before + share) / static_cast<double>(targets.size()));
    }));
  }
  return usable;
}

TouchPlan plan_touches(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
                       const std::vector<TouchTarget>& targets,
                       const std::vector<Obstacle>& obstacles, const Workspace& workspace,
                       const TouchPlanOptions& options, const Progress& progress) {
  const auto tell = [&](const char* stage, double share) {
    if (progress) progress(stage, share);
  };
  TouchPlan plan;
  Random random(options.seed);
  const auto usable =
      usable_touches(robot, xi, sets, targets, obstacles, options, random, progress);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TouchTarget& target = targets[t];
    const auto found = static_cast<int>(usable[t].size());
    if (found < target.touches && plan.unreached.empty())
      plan.unreached = "set " + sets[target.set].name + ": only " + std::to_string(found) + " of " +
                       std::to_string(target.touches) +
                       " touches are within the joint limits, the tilt and reach of home";
  }
  tell("choosing touches", 0);
  const std::vector<PlannedTouch> chosen =
      choose(robot, xi, sets, targets, usable, workspace, options.check, random, progress);
  tell("ordering touches", 0);
  plan.touches = in_short_order({robot, xi, obstacles, options.apart, options.home, options.speed},
                                sets, chosen);
  return plan;
}

ExpectedSigma expected_sigma(const Robot& robot, const Eigen::VectorXd& xi,
                             const std::vector<Set>& sets, const std::vector<TouchTarget>& targets,
                             const TouchPlan& plan, const Workspace& workspace,
                             const Progress& progress) {
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
  question.point_unknown = std::ranges::none_of(
      targets, [&](const TouchTarget& each) { return sets[each.set].method->sees_point(); });
  question.poses = random_poses(robot, nullptr, kPoses, kSeed);
  ExpectedSigma expected;
  expected.endpoint = endpoint_sigma(question);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(touches.size()), question.poses.cols());
  for (std::size_t i = 0; i < touches.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = touches[i].q.transpose();
  question.poses = workspace_poses(robot, xi, workspace, rows, kPoses, kSeed);
  expected.workspace = endpoint_sigma(question);
  if (question.poses.rows() > 0 && !touches.empty())
    expected.curve = sigma_by_count(robot, xi, sets, touches, endpoint_weight(question), progress);
  return expected;
}

MotionTime motion_time(const Robot& robot, const Eigen::VectorXd& xi, const TouchPlan& plan,
                       const TouchPlanOptions& options, double touch_speed, int repeats) {
  MotionTime time;
  Eigen::VectorXd here = options.home;
  const Eigen::VectorXd speed = Eigen::VectorXd::Constant(here.size(), options.speed);
  const auto travel = [&](const Eigen::VectorXd& to) {
    time.travel += joint_time(here, to, speed);
    here = to;
  };
  for (const PlannedTouch& each : plan.touches) {
    if (each.via_home) travel(options.home);
    for (const Eigen::VectorXd& place : each.way) travel(place);
    travel(each.start);
    const double speed_in = each.slow ? touch_speed / kSlower : touch_speed;
    const double way =
        (locate(robot, xi, each.touch).p - locate(robot, xi, each.start).p).norm() / speed_in;
    time.touching += repeats * (1 + 1 / kRetreatFaster) * way;
  }
  travel(options.home);
  return time;
}

}  // namespace selfcal
