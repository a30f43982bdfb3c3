// What no part of a robot may enter, and how thick the robot is.
//
// Surfaces that are touched keep the endpoint off the half ball behind them. Boxes along the
// world's axes and half-spaces are kept free of the whole robot: of its endpoint and, where its
// links are given as capsules, of these, which keep off each other and off surfaces, too.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "constraints/sampling/configurations.h"
#include "kinematics/robot.h"

namespace selfcal {

/// What lies behind a surface within its patch: the half ball that the endpoint must keep out of.
struct Obstacle {
  Eigen::Vector3d point, outward;  ///< m; unit
  Patch within;
};

/// A box or, without one, all that lies behind a plane.
struct KeepOut {
  std::optional<Eigen::AlignedBox3d> box;  ///< m, world
  Eigen::Vector3d point = Eigen::Vector3d::Zero(),
                  outward = Eigen::Vector3d::UnitZ();  ///< unit
};

/// All that is within `radius` of the segment from a to b, in the frame of a link (m).
struct Capsule {
  int link = 0;  ///< of Mechanics::links
  Eigen::Vector3d a, b;
  double radius = 0;
};

struct Fence {
  std::vector<KeepOut> keep_outs;
  std::vector<Capsule> capsules;  ///< none of a robot without statics
};

/// Least distance between the segments a b and c d, that of a b from a keep-out (negative behind a
/// half-space, zero within a box).
double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, const Eigen::Vector3d& d);
double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const KeepOut& keep);

/// Why the robot, its endpoint at `p` with readings `q`, is not free by `apart` (m): what it is too
/// near to; empty where it is. `touched` is the obstacle that the endpoint touches (-1: none), off
/// which the links behind the last joint need not keep.
std::string in_the_way(const Robot& robot, const Fence& fence,
                       const std::vector<Obstacle>& obstacles, const Eigen::VectorXd& q,
                       const Eigen::Vector3d& p, double apart, int touched);

}  // namespace selfcal
