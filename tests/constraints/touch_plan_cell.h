// Planes and sockets around the example robot, to plan touches of.
#pragma once

#include <string>
#include <vector>

#include "constraints/planning/touch_plan.h"
#include "tests/sim/simulated_robot.h"
#include "tests/support/end_position.h"

namespace selfcal {

// Newton steps end when the residual is below the 1e-9 m that contact.cc calls met.
inline constexpr double kMet = 1e-8;

inline Eigen::VectorXd home() {
  return (Eigen::VectorXd(6) << 0.0, -0.6, 0.9, 0.0, 1.2, 0.0).finished();
}

inline Location located(const Eigen::VectorXd& q) { return locate(rx90(), values(rx90()), q); }

inline Set set_of(const std::string& name, const std::string& method) {
  Problems none;
  Node entry = Node::map();
  entry.set("method", Node::of(method));
  return make_set(name, entry, none);
}

/// Planes and sockets around the robot.
struct PlannedCell {
  std::vector<Set> sets;
  std::vector<TouchTarget> targets;
  std::vector<Obstacle> obstacles;
  TouchPlanOptions options;
  PlannedCell() { options.home = home(); }

  PlannedCell& plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double radius,
                     int touches) {
    TouchTarget target;
    target.set = static_cast<int>(sets.size());
    target.touches = touches;
    target.outward = normal.normalized();
    target.plane = Plane{target.outward, target.outward.dot(point)};
    target.within = {point, radius};
    sets.push_back(set_of("plane" + std::to_string(sets.size()), "plane"));
    target.obstacle = static_cast<int>(obstacles.size());
    targets.push_back(target);
    obstacles.push_back({point, target.outward, target.within});
    return *this;
  }
  PlannedCell& sockets(const std::string& method, const std::vector<Location>& places,
                       int touches) {
    TouchTarget target;
    target.set = static_cast<int>(sets.size());
    target.touches = touches;
    target.outward = Eigen::Vector3d::UnitZ();
    target.places = places;
    sets.push_back(set_of("nests", method));
    targets.push_back(target);
    return *this;
  }
  TouchPlan plan() const {
    return plan_touches(rx90(), values(rx90()), sets, targets, obstacles, {}, options);
  }
};

inline PlannedCell table_and_wall(int touches = 12) {
  PlannedCell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, touches);
  cell.plane({0, 0.9, 0.7}, {0.1, -1, 0}, 0.25, touches);
  return cell;
}

}  // namespace selfcal
