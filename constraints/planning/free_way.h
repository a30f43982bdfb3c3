// Ways from one configuration of a cell to another that nothing stands in.
//
// The straight joint path where it is free. Where it is not, both ends go back a part of their ways
// to home, which are free, and the path between these places is tried; back to home itself, which
// always serves.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/planning/fence.h"
#include "kinematics/robot.h"

namespace selfcal {

/// True when the robot is free by `apart` (m) of every obstacle but `touched` (-1 for none) and of
/// the fence at all looked-at places of the straight joint path from `from` to `to`, and by at
/// least half of it, or less 2.5 mm, between them.
bool path_is_free(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const std::vector<Obstacle>& obstacles, double apart,
                  int touched = -1, const Fence& fence = {});

/// A way between two configurations, straight from each place to the next.
struct FreeWay {
  bool via_home = false;
  std::vector<Eigen::VectorXd> through;  ///< readings between them; empty where it leads via home
  double time = 0;                       ///< s
};

/// Where a robot moves between configurations. What it refers to outlives it.
struct Surroundings {
  const Robot& robot;
  const Eigen::VectorXd& xi;
  const std::vector<Obstacle>& obstacles;
  double apart;                 ///< m, kept from every obstacle
  const Eigen::VectorXd& home;  ///< readings
  double speed;                 ///< of every joint (rad/s, m/s), above 0
  Fence fence = {};
};

/// From one configuration to another, of which each is straight from home.
FreeWay free_way(const Surroundings& cell, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

}  // namespace selfcal
