#include "constraints/planning/fence.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr int kGoldenSteps = 40;  // each leaves 0.62 of the stretch

/// The last joint up to a link.
int carrying_joint(const Mechanics& mechanics, int link) {
  for (int l = link; l >= 0; --l)
    if (mechanics.links[static_cast<std::size_t>(l)].joint >= 0)
      return mechanics.links[static_cast<std::size_t>(l)].joint;
  return -1;
}

/// Least of `f`, which is convex, on the segment from a to b.
template <class Function>
double least_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Function& f) {
  if (a == b) return f(a);
  const auto at = [&](double s) { return f(Eigen::Vector3d(a + s * (b - a))); };
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
  return std::min({fx, fy, f(a), f(b)});
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
  return least_along(a, b, [&](const Eigen::Vector3d& p) {
    const double within =
        std::min((p - keep.box->min()).minCoeff(), (keep.box->max() - p).minCoeff());
    return within > 0 ? -within : keep.box->exteriorDistance(p);
  });
}

double distance_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Obstacle& obstacle) {
  return least_along(a, b, [&](const Eigen::Vector3d& p) {
    const double off = obstacle.outward.dot(p - obstacle.point);
    if (obstacle.within.radius <= 0) return off;
    return std::max(off, (p - obstacle.within.centre).norm() - obstacle.within.radius);
  });
}

std::vector<PlacedCapsule> placed_capsules(const Robot& robot, const Fence& fence,
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

Room room_of(const Robot& robot, const Fence& fence, const std::vector<Obstacle>& obstacles,
             const std::vector<PlacedCapsule>& capsules, const Eigen::Vector3d& p, double apart,
             int touched) {
  Room room;
  // True, with the reason, where there is none.
  const auto blocks = [&](double distance, const auto&... why) {
    room.least = std::min(room.least, distance);
    if (distance < 0) ((room.in_the_way += why), ...);
    return distance < 0;
  };
  for (std::size_t o = 0; o < obstacles.size(); ++o)
    if (static_cast<int>(o) != touched && blocks(distance_between(p, p, obstacles[o]) - apart,
                                                 "the endpoint is behind a surface or too near"))
      return room;
  for (const KeepOut& each : fence.keep_outs)
    if (blocks(distance_between(p, p, each) - apart, "the endpoint is where nothing may be"))
      return room;
  const int last = static_cast<int>(robot.joints().size()) - 1;
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const PlacedCapsule& one = capsules[i];
    for (const KeepOut& each : fence.keep_outs)
      if (blocks(distance_between(one.a, one.b, each) - one.radius - apart, "link ", *one.frame,
                 " is where nothing may be"))
        return room;
    for (std::size_t o = 0; o < obstacles.size(); ++o)
      if (!(static_cast<int>(o) == touched && one.joint == last) &&
          blocks(distance_between(one.a, one.b, obstacles[o]) - one.radius, "link ", *one.frame,
                 " is behind a surface"))
        return room;
    // Neighbours meet at the joint between them. Both of two may move.
    for (std::size_t k = 0; k < i; ++k)
      if (const PlacedCapsule& other = capsules[k];
          std::abs(one.joint - other.joint) > 1 &&
          blocks((distance_between(one.a, one.b, other.a, other.b) - one.radius - other.radius) / 2,
                 "links ", *other.frame, " and ", *one.frame, " meet"))
        return room;
  }
  return room;
}

std::string in_the_way(const Robot& robot, const Fence& fence,
                       const std::vector<Obstacle>& obstacles, const Eigen::VectorXd& q,
                       const Eigen::Vector3d& p, double apart, int touched) {
  return room_of(robot, fence, obstacles, placed_capsules(robot, fence, q), p, apart, touched)
      .in_the_way;
}

}  // namespace selfcal
