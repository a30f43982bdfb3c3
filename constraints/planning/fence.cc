#include "constraints/planning/fence.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr int kGoldenSteps = 40;  // each leaves 0.62 of the stretch

/// A capsule where its link is.
struct PlacedCapsule {
  Eigen::Vector3d a, b;
  double radius;
  int joint;  ///< that carries it; -1: none
  const std::string* frame;
};

/// The last joint up to a link.
int carrying_joint(const Mechanics& mechanics, int link) {
  for (int l = link; l >= 0; --l)
    if (mechanics.links[static_cast<std::size_t>(l)].joint >= 0)
      return mechanics.links[static_cast<std::size_t>(l)].joint;
  return -1;
}

std::vector<PlacedCapsule> placed(const Robot& robot, const Fence& fence,
                                  const Eigen::VectorXd& q) {
  std::vector<PlacedCapsule> list;
  if (fence.capsules.empty() || !robot.statics()) return list;
  const Mechanics& mechanics = robot.statics()->mechanics();
  const std::vector<Eigen::Isometry3d> poses = robot.statics()->link_poses(q);
  for (const Capsule& each : fence.capsules) {
    const auto link = static_cast<std::size_t>(each.link);
    list.push_back({poses[link] * each.a, poses[link] * each.b, each.radius,
                    carrying_joint(mechanics, each.link), &mechanics.links[link].frame});
  }
  return list;
}

bool behind_surface(const Obstacle& obstacle, const Eigen::Vector3d& p, double apart) {
  const bool near = obstacle.within.radius <= 0 ||
                    (p - obstacle.within.centre).norm() <= obstacle.within.radius + apart;
  return near && obstacle.outward.dot(p - obstacle.point) < apart;
}

}  // namespace

double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  // Ericson, Real-time collision detection, 5.1.9.
  const Eigen::Vector3d u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), vw = v.dot(w);
  const auto part = [](double over, double of) {
    return of > 0 ? std::clamp(over / of, 0.0, 1.0) : 0.0;
  };
  double s = part(uv * vw - u.dot(w) * vv, uu * vv - uv * uv);
  double t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (t < 0 || t > 1 || vv == 0) {
    t = std::clamp(t, 0.0, 1.0);
    s = part(t * uv - u.dot(w), uu);
  }
  return (w + s * u - t * v).norm();
}

double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const KeepOut& keep) {
  if (!keep.box)
    return std::min(keep.outward.dot(a - keep.point), keep.outward.dot(b - keep.point));
  // Convex along the segment.
  const auto at = [&](double s) {
    return keep.box->exteriorDistance(Eigen::Vector3d(a + s * (b - a)));
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 1, x = 1 - kGolden, y = kGolden, fx = at(x), fy = at(y);
  for (int i = 0; i < kGoldenSteps; ++i) {
    if (fx <= fy) {
      high = y;
      y = x;
      fy = fx;
      fx = at(x = high - kGolden * (high - low));
    } else {
      low = x;
      x = y;
      fx = fy;
      fy = at(y = low + kGolden * (high - low));
    }
  }
  return std::min({fx, fy, at(0), at(1)});
}

std::string in_the_way(const Robot& robot, const Fence& fence,
                       const std::vector<Obstacle>& obstacles, const Eigen::VectorXd& q,
                       const Eigen::Vector3d& p, double apart, int touched) {
  for (std::size_t o = 0; o < obstacles.size(); ++o)
    if (static_cast<int>(o) != touched && behind_surface(obstacles[o], p, apart))
      return "the endpoint is behind a surface or too near";
  for (const KeepOut& each : fence.keep_outs)
    if (distance_between(p, p, each) < apart) return "the endpoint is where nothing may be";
  const std::vector<PlacedCapsule> capsules = placed(robot, fence, q);
  const int last = static_cast<int>(robot.joints().size()) - 1;
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const PlacedCapsule& one = capsules[i];
    for (const KeepOut& each : fence.keep_outs)
      if (distance_between(one.a, one.b, each) < one.radius + apart)
        return "link " + *one.frame + " is where nothing may be";
    for (std::size_t o = 0; o < obstacles.size(); ++o)
      if (!(static_cast<int>(o) == touched && one.joint == last) &&
          (behind_surface(obstacles[o], one.a, one.radius) ||
           behind_surface(obstacles[o], one.b, one.radius)))
        return "link " + *one.frame + " is behind a surface";
    // Neighbours meet at the joint between them.
    for (std::size_t k = 0; k < i; ++k)
      if (std::abs(one.joint - capsules[k].joint) > 1 &&
          distance_between(one.a, one.b, capsules[k].a, capsules[k].b) <
              one.radius + capsules[k].radius)
        return "links " + *capsules[k].frame + " and " + *one.frame + " meet";
  }
  return {};
}

}  // namespace selfcal
