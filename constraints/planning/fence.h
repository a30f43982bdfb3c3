// What no part of a robot may enter, and how thick the robot is.
//
// Surfaces that are touched keep the endpoint off the half ball behind them. Boxes along the
// world's axes and half-spaces are kept free of the whole robot: of its endpoint and, where its
// links are given as capsules, of these, which keep off each other and off surfaces, too.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <limits>
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

/// Least distance between the segments a b and c d, that of a b from a keep-out (negative where it
/// is in it).
double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, const Eigen::Vector3d& d);
double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const KeepOut& keep);

/// Least distance of the segment a b from the half ball behind a surface (m), a lower bound that is
/// negative only where the segment is in it.
double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Obstacle& obstacle);

/// A capsule where its link is.
struct PlacedCapsule {
  Eigen::Vector3d a, b;  ///< m, world
  double radius = 0;
  int joint = -1;  ///< that carries it; -1: none
  const std::string* frame = nullptr;
};

/// Those of the fence at readings `q`; the robot outlives them.
std::vector<PlacedCapsule> placed_capsules(const Robot& robot, const Fence& fence,
                                           const Eigen::VectorXd& q);

/// How far the robot is from what it must keep off.
struct Room {
  /// m: so far every point of it may move before it is too near to anything; a lower bound.
  double least = std::numeric_limits<double>::infinity();
  std::string in_the_way;  ///< what it is too near to already; empty where it is free
};

/// Of a robot with its endpoint at `p`, free where nothing is nearer than `apart` (m). `touched` is
/// the obstacle that the endpoint touches (-1: none), off which the links behind the last joint
/// need not keep.
Room room_of(const Robot& robot, const Fence& fence, const std::vector<Obstacle>& obstacles,
             const std::vector<PlacedCapsule>& capsules, const Eigen::Vector3d& p, double apart,
             int touched);

/// What a robot with readings `q` and its endpoint at `p` is too near to; empty where it is free.
std::string in_the_way(const Robot& robot, const Fence& fence,
                       const std::vector<Obstacle>& obstacles, const Eigen::VectorXd& q,
                       const Eigen::Vector3d& p, double apart, int touched);

}  // namespace selfcal
