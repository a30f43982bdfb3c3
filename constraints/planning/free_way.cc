// The straight joint path from q_a to q_b, looked at in so many places that nothing fits between
// neighbours. A point of the robot moves between two of them along its chord, off which it is
//   e <= rho theta^2 / 8,   theta = sum over joints of |dq|, rho the reach,
// for |p''| <= rho (sum |q'|)^2 of a chain. With r free of everything at each end, the whole
// stretch is free where chord + 2 e <= r_a + r_b; a stretch where it is not is halved.
#include "constraints/planning/free_way.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "constraints/planning/tour.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kFirstTurn = 0.25;  // joint units of a stretch before any is halved
constexpr int kHalvings = 20;        // a machine that has jumped until then has no way there
/// Of the robot's size, that a stretch may be long next to what is in the way, where less or
/// nothing is kept apart.
constexpr double kLeastStretch = 5e-3;
/// Of the way from home, where the two ends leave it for each other.
constexpr double kShares[] = {0.9, 0.75, 0.6, 0.45, 0.3, 0.15};

/// What may stand in a path.
struct Obstruction {
  const std::vector<Obstacle>& obstacles;
  double apart;
  int touched;
  const Fence& fence;
};

/// One place of a path: what of the robot is looked at, and how far it is from everything.
struct Place {
  double share = 0;  ///< of the path
  double room = 0;   ///< m
  std::vector<Eigen::Vector3d> points;
};

class Path {
 public:
  Path(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& from,
       const Eigen::VectorXd& to, const Obstruction& obstruction)
      : robot_(robot), xi_(xi), from_(from), way_(to - from), in_(obstruction) {
    for (const Parameter& each : robot.parameters())
      if (each.quantity == Quantity::length && each.part == Part::tool)
        reach_ += std::abs(each.nominal);
    double beside = 0;
    for (const Capsule& each : in_.fence.capsules)
      beside = std::max({beside, each.a.norm(), each.b.norm()});
    reach_ += beside;
  }

  bool is_free() {
    const int stretches =
        std::clamp(static_cast<int>(std::ceil(turn_ / kFirstTurn)), 1, kLanes - 1);
    std::vector<double> shares;
    for (int i = 0; i <= stretches; ++i) shares.push_back(static_cast<double>(i) / stretches);
    if (!look(shares)) return false;
    std::vector<std::array<std::size_t, 2>> open;
    for (std::size_t i = 1; i < places_.size(); ++i) open.push_back({i - 1, i});
    for (int halved = 0; halved < kHalvings; ++halved) {
      std::erase_if(open,
                    [&](const auto& each) { return settled(places_[each[0]], places_[each[1]]); });
      if (open.empty()) return true;
      shares.clear();
      for (const auto& [a, b] : open) shares.push_back((places_[a].share + places_[b].share) / 2);
      std::size_t middle = places_.size();
      if (!look(shares)) return false;
      std::vector<std::array<std::size_t, 2>> halves;
      for (const auto& [a, b] : open) {
        halves.push_back({a, middle});
        halves.push_back({middle++, b});
      }
      open = std::move(halves);
    }
    return false;
  }

 private:
  /// Adds these places of the path; false where the robot is not free in one.
  bool look(const std::vector<double>& shares) {
    ConfigurationBlock block{Eigen::ArrayXXd(kLanes, from_.size()), kLanes};
    Locations X;
    for (std::size_t first = 0; first < shares.size(); first += kLanes) {
      block.count = static_cast<int>(std::min<std::size_t>(kLanes, shares.size() - first));
      const auto share = [&](int lane) {
        return shares[first + static_cast<std::size_t>(std::min(lane, block.count - 1))];
      };
      for (int lane = 0; lane < kLanes; ++lane)
        block.q.row(lane) = (from_ + share(lane) * way_).transpose().array();
      if (!robot_.locate(block, xi_, Body::endpoint, X, nullptr).closes()) return false;
      for (int lane = 0; lane < block.count; ++lane)
        if (!add(share(lane), block.q.row(lane).matrix().transpose(), X.p(lane))) return false;
    }
    return true;
  }

  bool add(double share, const Eigen::VectorXd& q, const Eigen::Vector3d& tip) {
    const std::vector<PlacedCapsule> capsules = placed_capsules(robot_, in_.fence, q);
    const Room room =
        room_of(robot_, in_.fence, in_.obstacles, capsules, tip, in_.apart, in_.touched);
    Place place{share, room.least, {tip}};
    for (const PlacedCapsule& each : capsules) {
      place.points.push_back(each.a);
      place.points.push_back(each.b);
    }
    places_.push_back(std::move(place));
    return room.in_the_way.empty();
  }

  /// Nothing fits between two places but what comes nearer by half of what is kept apart.
  bool settled(const Place& a, const Place& b) const {
    double chord = 0;
    for (std::size_t i = 0; i < a.points.size(); ++i)
      chord = std::max(chord, (a.points[i] - b.points[i]).norm());
    const double turn = (b.share - a.share) * turn_, off_chord = reach_ * turn * turn / 8;
    return chord + 2 * off_chord <= a.room + b.room + std::max(in_.apart, least_stretch_);
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const Eigen::VectorXd& from_;
  const Eigen::VectorXd way_;
  const Obstruction in_;
  const double turn_ = (way_.array().abs() / units_of_readings(robot_)).sum();
  double reach_ = size_of(robot_);  ///< of the tip and the capsules' ends, from any joint
  const double least_stretch_ = kLeastStretch * size_of(robot_);
  std::vector<Place> places_;
};

}  // namespace

bool path_is_free(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const std::vector<Obstacle>& obstacles, double apart,
                  int touched, const Fence& fence) {
  return Path(robot, xi, from, to, {obstacles, apart, touched, fence}).is_free();
}

FreeWay free_way(const Surroundings& cell, const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const Eigen::VectorXd speed = Eigen::VectorXd::Constant(from.size(), cell.speed);
  const auto time = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return joint_time(a, b, speed);
  };
  const auto is_free = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return path_is_free(cell.robot, cell.xi, a, b, cell.obstacles, cell.apart, -1, cell.fence);
  };
  if (is_free(from, to)) return {false, {}, time(from, to)};
  const double through_home = time(from, cell.home) + time(cell.home, to);
  for (const double share : kShares) {
    const Eigen::VectorXd a = cell.home + share * (from - cell.home);
    const Eigen::VectorXd b = cell.home + share * (to - cell.home);
    const double way = time(from, a) + time(a, b) + time(b, to);
    if (way < through_home && is_free(a, b) && is_free(from, a) && is_free(b, to))
      return {false, {a, b}, way};
  }
  return {true, {}, through_home};
}

}  // namespace selfcal
