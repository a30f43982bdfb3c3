#include "constraints/planning/touch_candidates.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "constraints/methods/shared/shared_point.h"
#include "constraints/methods/shared/unit_normal.h"
#include "constraints/planning/free_way.h"
#include "constraints/sampling/contact.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kCandidatesEach = 4;  // sampled for each touch that is asked for
constexpr int kPostures = 4;        // of the robot at one point of a surface
constexpr int kPointTries = 2;      // blocks of starts before a point of a surface is given up
constexpr double kEdge = 0.02;      // of a patch, kept free at its edge
constexpr int kStepsBack = 4;       // of Newton, back to a plane
constexpr double kOnPlane = 1e-7;   // of the robot's size
constexpr int kSpacedTries = 50;    // of a point that is far enough from the others
constexpr double kHeld = 0.8;       // of the way at which a touch begins, kept on the way to it
constexpr int kRounds = 24;         // of sampling, until enough candidates are usable

}  // namespace

std::vector<std::optional<Eigen::VectorXd>> TouchCandidates::moved(
    const TouchTarget& target, const PlannedTouch& touch, const Eigen::MatrixXd& by) const {
  const auto count = static_cast<int>(by.cols());
  ConfigurationBlock block{touch.touch.transpose().replicate(kLanes, 1).array(), count};
  block.q.topRows(count) += by.transpose().array();
  Locations X;
  Closure closure;
  const auto miss = [&](int lane) {
    return target.plane->d.value() - target.plane->n.dot(X.p(lane));
  };
  PsiBlock psi;
  Eigen::MatrixXd J;
  for (int step = 0; step < kStepsBack; ++step) {
    closure = robot_.locate(block, xi_, Body::endpoint, X, &psi);
    robot_.joint_jacobian(block, xi_, Body::endpoint, psi, J);
    for (int lane = 0; lane < count; ++lane) {
      Eigen::RowVectorXd towards = Eigen::RowVectorXd::Zero(J.cols());
      for (int c = 0; c < 3; ++c) towards += target.plane->n[c] * J.row(c * kLanes + lane);
      if (closure.closes(lane) && towards.squaredNorm() > 0)
        block.q.row(lane) += miss(lane) / towards.squaredNorm() * towards.array();
    }
  }
  closure.add(robot_.locate(block, xi_, Body::endpoint, X, nullptr));
  const double on_plane = kOnPlane * size_of(robot_);
  std::vector<std::optional<Eigen::VectorXd>> list(static_cast<std::size_t>(count));
  for (int lane = 0; lane < count; ++lane) {
    const Eigen::VectorXd q = block.q.row(lane).matrix().transpose();
    const Patch inner{target.within.centre, (1 - kEdge) * target.within.radius};
    if (closure.closes(lane) && std::abs(miss(lane)) < on_plane && inner.contains(X.p(lane)) &&
        within_limits(robot_, q, options_.limit_margin))
      list[static_cast<std::size_t>(lane)] = q;
  }
  return list;
}

std::optional<PlannedTouch> TouchCandidates::at(const TouchTarget& target,
                                                const PlannedTouch& touch,
                                                const Eigen::VectorXd& q) const {
  DataSet data;
  data.sets = {sets_[target.set]};
  data.sets[0].method = shared_point();
  data.sets[0].reference = -1;
  data.sets[0].groups = {"g0"};
  data.rows.set = {0};
  data.rows.group = {0};
  data.rows.check = {0};
  data.rows.q = q.transpose();
  State truth;
  truth.xi = xi_;
  truth.nuisance.resize(1);
  truth.groups = {shared_point()->start_group({locate(robot_, xi_, q)})};
  PlannedTouch there = touch;
  there.touch = q;
  const std::vector<PlannedTouch> made = entered(target, data, truth, {0}, {there});
  if (made.empty()) return std::nullopt;
  return made.front();
}

std::vector<PlannedTouch> TouchCandidates::of(const TouchTarget& target, Random& random,
                                              const std::function<void(double)>& tell) const {
  std::vector<PlannedTouch> usable;
  const int wanted = kCandidatesEach * target.touches;
  for (int round = 0; round < kRounds && static_cast<int>(usable.size()) < wanted; ++round) {
    tell(static_cast<double>(usable.size()) / wanted);
    sample(target, random, usable);
  }
  return usable;
}

void TouchCandidates::sample(const TouchTarget& target, Random& random,
                             std::vector<PlannedTouch>& usable) const {
  const int rows = kCandidatesEach * target.touches;
  SampleRequest request;
  request.together = target.places.empty();
  if (target.plane) {
    request.rows = request.rows_per_group = kPostures;
    request.tries = kPointTries;
    for (int point = 0; point < rows; point += kPostures) {
      const std::optional<Eigen::Vector3d> place = spaced_point(target, usable, random);
      if (!place) return;
      request.places = {{Eigen::Matrix3d::Identity(), *place}};
      take(target, shared_point(), request, random, usable);
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
  take(target, method, request, random, usable);
}

/// Anywhere on the nominal surface within its patch, but at its edge, which a touch may miss (m).
Eigen::Vector3d TouchCandidates::point_of(const TouchTarget& target, Random& random) const {
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

/// The same, far enough from the points of the usable touches; nothing where none was found.
std::optional<Eigen::Vector3d> TouchCandidates::spaced_point(
    const TouchTarget& target, const std::vector<PlannedTouch>& usable, Random& random) const {
  if (options_.spacing <= 0) return point_of(target, random);
  std::vector<Eigen::Vector3d> taken;
  for (const PlannedTouch& each : usable) taken.push_back(locate(robot_, xi_, each.touch).p);
  for (int attempt = 0; attempt < kSpacedTries; ++attempt) {
    const Eigen::Vector3d p = point_of(target, random);
    // Other postures at one point are as good as other points.
    if (std::ranges::all_of(taken, [&](const Eigen::Vector3d& other) {
          return (p - other).norm() >= options_.spacing;
        }))
      return p;
  }
  return std::nullopt;
}

/// Those of the sampled configurations that are usable.
void TouchCandidates::take(const TouchTarget& target, const std::shared_ptr<const Method>& method,
                           const SampleRequest& request, Random& random,
                           std::vector<PlannedTouch>& usable) const {
  DataSet data;
  data.sets = {sets_[target.set]};
  data.sets[0].method = method;
  data.sets[0].reference = -1;
  const Sampled sampled = sample_rows(robot_, xi_, {request}, random, data);
  std::vector<int> rows;
  std::vector<PlannedTouch> touches;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int group = data.rows.group[row];
    if (group >= static_cast<int>(request.places.size()) && !request.places.empty()) continue;
    PlannedTouch touch;
    touch.set = target.set;
    touch.group = target.places.empty() ? -1 : group;
    touch.touch = data.rows.q.row(row).transpose();
    rows.push_back(row);
    touches.push_back(touch);
  }
  std::ranges::move(entered(target, data, sampled.truth, rows, touches),
                    std::back_inserter(usable));
}

std::vector<PlannedTouch> TouchCandidates::entered(const TouchTarget& target, const DataSet& data,
                                                   const State& truth, const std::vector<int>& rows,
                                                   const std::vector<PlannedTouch>& touches) const {
  std::vector<PlannedTouch> made;
  // How far along the way out, the endpoint's orientation as it comes: outside, start and end.
  std::vector<double> distances = {options_.clearance};
  if (target.places.empty()) distances.insert(distances.end(), {options_.slow, -options_.search});
  const std::size_t ends = distances.size();
  std::vector<int> from;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    PlannedTouch touch = touches[i];
    touch.outside = touch.start = touch.end = touch.touch;
    if (locks(target.set)) {
      if (free_to_enter(target, touch)) made.push_back(touch);
      continue;
    }
    const Location X = locate(robot_, xi_, touch.touch);
    if ((X.R * robot_.tool_axis()).dot(-target.outward) < std::cos(options_.tilt)) continue;
    made.push_back(touch);
    from.insert(from.end(), ends, rows[i]);
  }
  if (from.empty()) return made;
  const auto moves = static_cast<Eigen::Index>(from.size());
  const auto equations = static_cast<Eigen::Index>(data.sets[0].method->equations().size());
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(moves, equations),
                  q(moves, touches.front().touch.size());
  for (Eigen::Index i = 0; i < moves; ++i) {
    const std::size_t move = static_cast<std::size_t>(i);
    wanted.row(i).head<3>() = distances[move % ends] * target.outward.transpose();
    q.row(i) = made[move / ends].touch.transpose();
  }
  const auto out = moved_to_residuals(robot_, data, truth, from, wanted, q);
  std::vector<PlannedTouch> free;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(ends * i);
    if (!std::all_of(end, end + static_cast<std::ptrdiff_t>(ends),
                     [](const auto& each) { return each.has_value(); }))
      continue;
    PlannedTouch& touch = made[i];
    touch.outside = touch.start = **end;
    if (ends > 1) {
      touch.start = *end[1];
      touch.end = *end[2];
    }
    if (free_to_enter(target, touch)) free.push_back(touch);
  }
  return free;
}

bool TouchCandidates::free_to_enter(const TouchTarget& target, const PlannedTouch& touch) const {
  const auto is_free = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, int touched) {
    return path_is_free(robot_, xi_, from, to, obstacles_, options_.apart, touched, options_.fence);
  };
  if (locks(target.set))
    return within_limits(robot_, touch.touch, options_.limit_margin) &&
           is_free(options_.home, touch.touch, -1);
  return within_limits(robot_, touch.outside, options_.limit_margin) &&
         within_limits(robot_, touch.start, options_.limit_margin) &&
         within_limits(robot_, touch.end, options_.limit_margin) &&
         is_free(touch.outside, touch.start, target.obstacle) &&
         is_free(touch.start, touch.end, target.obstacle) &&
         is_free(options_.home, touch.outside, -1) && straight_from_home(touch, target.obstacle);
}

/// Through home the robot comes to where it becomes slow, and goes back from there, at once.
bool TouchCandidates::straight_from_home(const PlannedTouch& touch, int obstacle) const {
  if (touch.start == touch.outside) return true;
  return path_is_free(robot_, xi_, options_.home, touch.start, obstacles_, options_.apart, obstacle,
                      options_.fence) &&
         (obstacle < 0 ||
          path_is_free(robot_, xi_, options_.home, touch.start,
                       {obstacles_[static_cast<std::size_t>(obstacle)]}, kHeld * options_.slow));
}

}  // namespace selfcal
