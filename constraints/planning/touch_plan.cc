#include "constraints/planning/touch_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/planning/touch_choice.h"
#include "constraints/planning/tour.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"

namespace selfcal {
namespace {

constexpr int kPoses = 500;  // at which the end position is judged
constexpr unsigned long long kSeed = 1;
constexpr int kLongestTries = 6;     // of fewer touches, until the motion is short enough
constexpr double kLessTime = 0.97;   // of the share of touches that the time is for
constexpr double kWellSpent = 0.95;  // of the time: no more touches are tried then
constexpr int kFewestTouches = 4;    // of a set
constexpr std::size_t kNear = 12;    // touches to which a free way is looked for
constexpr double kOtherSet = 1e4;    // s, that no order gains by leaving a set unfinished

/// All that a choice is made of.
struct Choosing {
  const Robot& robot;
  const Eigen::VectorXd& xi;
  const std::vector<Set>& sets;
  const std::vector<TouchTarget>& targets;
  const Workspace& workspace;
  const TouchPlanOptions& options;
  const TouchCandidates& candidates;
  const std::vector<std::vector<PlannedTouch>>& usable;  ///< by target
};

/// How touches of planes are moved; others stay. `touches` are those of `possible`, `of` their
/// targets.
TouchMoves moves_of(const Choosing& c, const std::vector<std::size_t>& of,
                    std::vector<PlannedTouch>& touches,
                    std::vector<std::optional<Eigen::VectorXd>>& looked) {
  TouchMoves moves;
  moves.look = [&](int i, const Eigen::MatrixXd& by) {
    const auto at = static_cast<std::size_t>(i);
    const TouchTarget& target = c.targets[of[at]];
    std::vector<std::optional<PossibleTouch>> list(static_cast<std::size_t>(by.cols()));
    // Near where the loops of a machine come into another way of closing the maker's figures do not
    // tell on which side of it the true machine is.
    if (!target.plane || c.options.spacing > 0 || c.robot.has_loops()) return list;
    looked = c.candidates.moved(target, touches[at], by);
    for (std::size_t k = 0; k < list.size(); ++k)
      if (looked[k]) list[k] = PossibleTouch{*looked[k], target.set, -1, target.outward};
    return list;
  };
  moves.take = [&](int i, int column) {
    const auto at = static_cast<std::size_t>(i);
    const auto there =
        c.candidates.at(c.targets[of[at]], touches[at], *looked[static_cast<std::size_t>(column)]);
    if (there) touches[at] = *there;
    return there.has_value();
  };
  return moves;
}

/// Those of the usable touches that tell most together, a share of as many of each set as are asked
/// for; of these again a share, drawn from the rest, is kept aside to judge.
std::vector<PlannedTouch> choose(const Choosing& c, double share, Random& random,
                                 const Progress& progress) {
  std::vector<PossibleTouch> possible;
  std::vector<PlannedTouch> touches;
  std::vector<std::size_t> of;
  TouchCounts counts{std::vector<int>(c.sets.size(), 0), std::vector<int>(c.sets.size(), 0)};
  for (std::size_t t = 0; t < c.targets.size(); ++t) {
    const int set = c.targets[t].set;
    const int wanted = std::max(std::min(kFewestTouches, c.targets[t].touches),
                                static_cast<int>(share * c.targets[t].touches));
    const int kept = static_cast<int>(c.options.check * wanted);
    counts.check[set] = kept;
    counts.fit[set] = wanted - kept;
    for (const PlannedTouch& each : c.usable[t]) {
      possible.push_back({each.touch, each.set, each.group, c.targets[t].outward});
      touches.push_back(each);
      of.push_back(t);
    }
  }
  std::vector<std::optional<Eigen::VectorXd>> looked;
  const TouchChoice choice =
      choose_touches(c.robot, c.xi, c.sets, possible, counts, c.workspace, random, progress,
                     moves_of(c, of, touches, looked), c.options.known);
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
  for (const PlannedTouch& each : touches) places.push_back(&each.outside);
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

/// What is said of those that each set lacks, of `touches`.
std::string in_words(const std::map<int, int>& left_out, const std::vector<Set>& sets,
                     const std::vector<PlannedTouch>& touches) {
  std::string words;
  for (const auto& [set, count] : left_out)
    words += (words.empty() ? "" : "; ") + std::string("set ") +
             sets[static_cast<std::size_t>(set)].name + ": " + std::to_string(count) + " of " +
             std::to_string(std::ranges::count(touches, set, &PlannedTouch::set)) +
             " touches are left out, for no straight way to them is free with the lock engaged";
  return words;
}

}  // namespace

TouchPlan in_short_order(const Surroundings& cell, const std::vector<Set>& sets,
                         const std::vector<PlannedTouch>& touches) {
  TouchPlan plan;
  std::vector<PlannedTouch>& path = plan.touches;
  std::map<int, int> left_out;  // by set
  for (const int place : short_tour_from_first(times_between(cell, touches))) {
    if (place == 0) continue;
    PlannedTouch next = touches[static_cast<std::size_t>(place) - 1];
    const Eigen::VectorXd& from = path.empty() ? cell.home : path.back().outside;
    const FreeWay way = free_way(cell, from, next.outside);
    next.via_home = way.via_home;
    next.way = way.via_home ? std::vector<Eigen::VectorXd>() : way.through;
    if (!way.via_home) {
      // Straight out of the last contact as far as free ways go, and straight into this one.
      if (!path.empty() && path.back().outside != path.back().start)
        next.way.insert(next.way.begin(), path.back().outside);
      if (next.outside != next.start) next.way.push_back(next.outside);
    }
    // A lock stays engaged from its first configuration to its last.
    const bool held = !path.empty() && path.back().set == next.set &&
                      sets[static_cast<std::size_t>(next.set)].method->planned() == Planned::lock;
    if (held && (next.via_home || !next.way.empty()))
      ++left_out[next.set];
    else
      path.push_back(std::move(next));
  }
  plan.left_out = in_words(left_out, sets, touches);
  return plan;
}

std::vector<std::vector<PlannedTouch>> usable_touches(const TouchCandidates& candidates,
                                                      const std::vector<TouchTarget>& targets,
                                                      Random& random, const Progress& progress) {
  std::vector<std::vector<PlannedTouch>> usable;
  for (const TouchTarget& target : targets) {
    const auto before = static_cast<double>(usable.size());
    usable.push_back(candidates.of(target, random, [&](double share) {
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
  const TouchCandidates candidates(robot, xi, sets, obstacles, options);
  Random random(options.seed);
  const auto usable = usable_touches(candidates, targets, random, progress);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TouchTarget& target = targets[t];
    const auto found = static_cast<int>(usable[t].size());
    if (found < target.touches && plan.unreached.empty())
      plan.unreached = "set " + sets[target.set].name + ": only " + std::to_string(found) + " of " +
                       std::to_string(target.touches) +
                       " touches are within the joint limits, the tilt and reach of home" +
                       (options.spacing > 0 ? ", and so far apart (motion: spacing)" : "");
  }
  const Choosing choosing{robot, xi, sets, targets, workspace, options, candidates, usable};
  const Surroundings cell{robot,         xi,           obstacles, options.apart, options.home,
                          options.speed, options.fence};
  double share = 1, too_many = 1;  // of the touches
  std::optional<TouchPlan> best;
  for (int attempt = 0; attempt < kLongestTries; ++attempt) {
    tell("choosing touches", 0);
    const std::vector<PlannedTouch> chosen = choose(choosing, share, random, progress);
    tell("ordering touches", 0);
    TouchPlan ordered = in_short_order(cell, sets, chosen);
    plan.touches = std::move(ordered.touches);
    plan.left_out = std::move(ordered.left_out);
    const double takes = motion_time(robot, xi, plan, options).total();
    if (options.longest <= 0) return plan;
    if (takes <= options.longest) {
      if (!best || best->touches.size() < plan.touches.size()) best = plan;
      if (share == 1 || takes > kWellSpent * options.longest) break;
      share = (share + too_many) / 2;
    } else {
      too_many = share;
      share *= kLessTime * options.longest / takes;
    }
  }
  if (best)
    plan = *std::move(best);
  else if (plan.unreached.empty())
    plan.unreached = "the motion takes longer than it may (motion: longest)";
  return plan;
}

ExpectedSigma expected_sigma(const Robot& robot, const Eigen::VectorXd& xi,
                             const std::vector<Set>& sets, const std::vector<TouchTarget>& targets,
                             const TouchPlan& plan, const Workspace& workspace,
                             const Progress& progress, const Eigen::MatrixXd& prior) {
  std::vector<PossibleTouch> touches;
  for (const TouchTarget& target : targets)
    for (const PlannedTouch& each : plan.touches)
      if (each.set == target.set && !each.check)
        touches.push_back({each.touch, each.set, each.group, target.outward});
  EndpointQuestion question;
  question.robot = &robot;
  question.xi = xi;
  question.unseen = unseen_by_touches(robot, xi, sets, touches);
  question.point_unknown = std::ranges::none_of(
      targets, [&](const TouchTarget& each) { return sets[each.set].method->sees_point(); });
  question.poses = random_poses(robot, nullptr, kPoses, kSeed);
  const Eigen::MatrixXd C = covariance_after(robot, xi, sets, touches, prior);
  ExpectedSigma expected;
  expected.endpoint = endpoint_sigma(endpoint_deviations(question), C);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(touches.size()), question.poses.cols());
  for (std::size_t i = 0; i < touches.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = touches[i].q.transpose();
  question.poses = workspace_poses(robot, xi, workspace, rows, kPoses, kSeed);
  const EndpointDeviations there = endpoint_deviations(question);
  expected.workspace = endpoint_sigma(there, C);
  if (question.poses.rows() > 0 && !touches.empty())
    expected.curve = sigma_by_count(robot, xi, sets, touches, there.weight, progress, prior);
  return expected;
}

MotionTime motion_time(const Robot& robot, const Eigen::VectorXd& xi, const TouchPlan& plan,
                       const TouchPlanOptions& options) {
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
    const double speed_in = each.slow ? options.touch_speed / kSlower : options.touch_speed;
    const double way =
        (locate(robot, xi, each.touch).p - locate(robot, xi, each.start).p).norm() / speed_in;
    const double out =
        each.group < 0 ? joint_time(each.touch, each.start, speed) : way / kRetreatFaster;
    time.touching += options.repeats * (way + out);
  }
  travel(options.home);
  return time;
}

}  // namespace selfcal
