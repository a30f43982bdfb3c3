#include "constraints/planning/other_approach.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kDraws = 12;            // of directions, for each way that is asked for
constexpr int kSecants = 4;           // until the start is as far out as it shall be
constexpr double kMostTurn = 0.6;     // of a joint's unit, that it moves on the way in
constexpr double kMostAside = 2.5;    // times the clearance, that the tip moves along the surface
constexpr double kNearHeight = 0.02;  // of the wanted height
constexpr double kStep = 1e-4;        // of a direction, for its slope

class ApproachFinder {
 public:
  ApproachFinder(const Robot& robot, const Eigen::VectorXd& xi, const TouchTarget& target,
                 const PlannedTouch& touch)
      : robot_(robot),
        xi_(xi),
        target_(target),
        touch_(touch),
        tip_(locate(robot, xi, touch.touch).p) {}

  /// Readings along `direction` from the contact at which the tip is `height` (m) out of it.
  std::optional<Eigen::VectorXd> at_height(const Eigen::VectorXd& direction, double height) const {
    double a = 0, b = height * slope(direction), at_a = 0;
    for (int i = 0; i < kSecants; ++i) {
      if (!(std::abs(b) * (direction.array().abs() / units_).maxCoeff() < kMostTurn))
        return std::nullopt;
      const double at_b = height_of(touch_.touch + b * direction);
      if (std::abs(at_b - height) < kNearHeight * std::abs(height))
        return touch_.touch + b * direction;
      if (at_b == at_a) return std::nullopt;
      const double next = b + (height - at_b) * (b - a) / (at_b - at_a);
      a = b;
      at_a = at_b;
      b = next;
    }
    return std::nullopt;
  }

  double aside(const Eigen::VectorXd& q) const {
    const Eigen::Vector3d way = locate(robot_, xi_, q).p - tip_;
    return (way - target_.outward.dot(way) * target_.outward).norm();
  }

 private:
  double height_of(const Eigen::VectorXd& q) const {
    return target_.outward.dot(locate(robot_, xi_, q).p - tip_);
  }
  /// Along the direction, over the height.
  double slope(const Eigen::VectorXd& direction) const {
    return kStep / height_of(touch_.touch + kStep * direction);
  }

  const Robot& robot_;
  const Eigen::ArrayXd units_ = units_of_readings(robot_);
  const Eigen::VectorXd& xi_;
  const TouchTarget& target_;
  const PlannedTouch& touch_;
  Eigen::Vector3d tip_;
};

}  // namespace

std::vector<PlannedTouch> other_approaches(const Robot& robot, const Eigen::VectorXd& xi,
                                           const TouchTarget& target,
                                           const std::vector<Obstacle>& obstacles,
                                           const TouchPlanOptions& options,
                                           const PlannedTouch& touch, int count, Random& random) {
  std::vector<PlannedTouch> found;
  if (!target.plane) return found;
  const ApproachFinder finder(robot, xi, target, touch);
  std::normal_distribution<double> normal;
  const Eigen::ArrayXd units = units_of_readings(robot);
  const auto usable = [&](const PlannedTouch& each) {
    return within_limits(robot, each.outside, options.limit_margin) &&
           within_limits(robot, each.end, options.limit_margin) &&
           finder.aside(each.outside) < kMostAside * options.clearance &&
           path_is_free(robot, xi, each.outside, each.end, obstacles, options.apart,
                        target.obstacle, options.fence) &&
           path_is_free(robot, xi, options.home, each.start, obstacles, options.apart,
                        target.obstacle, options.fence);
  };
  for (int draw = 0; draw < count * kDraws && static_cast<int>(found.size()) < count; ++draw) {
    const Eigen::VectorXd direction =
        units * Eigen::ArrayXd::NullaryExpr(touch.touch.size(), [&] { return normal(random); });
    const auto outside = finder.at_height(direction, options.clearance);
    const auto start = finder.at_height(direction, std::min(options.slow, options.clearance));
    const auto end = finder.at_height(direction, -options.search);
    if (!outside || !start || !end) continue;
    PlannedTouch other = touch;
    other.outside = *outside;
    other.start = *start;
    other.end = *end;
    if (usable(other)) found.push_back(std::move(other));
  }
  return found;
}

}  // namespace selfcal
