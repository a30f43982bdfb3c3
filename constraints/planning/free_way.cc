#include "constraints/planning/free_way.h"

#include <cmath>

#include "constraints/planning/tour.h"

namespace selfcal {
namespace {

constexpr int kPathBlocks = 3;  // of kLanes places along a path
/// Of the way from home, where the two ends leave it for each other.
constexpr double kShares[] = {0.9, 0.75, 0.6, 0.45, 0.3, 0.15};

}  // namespace

bool path_is_free(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const std::vector<Obstacle>& obstacles, double apart,
                  int touched, const Fence& fence) {
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, from.size()), kLanes};
  Locations X;
  for (int part = 0; part < kPathBlocks; ++part) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double s = (part * kLanes + lane) / (kPathBlocks * kLanes - 1.0);
      block.q.row(lane) = (from + s * (to - from)).transpose().array();
    }
    if (!robot.locate(block, xi, Body::endpoint, X, nullptr).closes()) return false;
    for (int lane = 0; lane < kLanes; ++lane)
      if (!in_the_way(robot, fence, obstacles, block.q.row(lane).matrix().transpose(), X.p(lane),
                      apart, touched)
               .empty())
        return false;
  }
  return true;
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
