// The longest way D of a joint sets the pace:
//   v = min(speed, sqrt(D a)),  speeding up takes v / a,  the even part (D - v^2 / a) / v.
#include "app/bridge/approach.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

/// The point at the share `s` of the way, at the rate `v` of the longest way `longest`.
TrajectoryPoint point_at(const std::vector<double>& from, const std::vector<double>& to,
                         double longest, double time, double s, double v) {
  TrajectoryPoint point{.time = time, .q = to, .dq = std::vector<double>(to.size(), 0)};
  for (std::size_t j = 0; j < to.size(); ++j) {
    if (s < 1) point.q[j] = from[j] + s * (to[j] - from[j]);
    if (longest > 0) point.dq[j] = v * (to[j] - from[j]) / longest;
  }
  return point;
}

}  // namespace

std::vector<TrajectoryPoint> approach(const std::vector<double>& from,
                                      const std::vector<double>& to, double speed,
                                      double acceleration) {
  constexpr double kAtOnce = 1e-2;  // s: a controller refuses a trajectory of no time
  constexpr double kEven = 1e-6;    // of the whole time: a shorter even part is none
  double longest = 0;
  for (std::size_t j = 0; j < to.size(); ++j)
    longest = std::max(longest, std::abs(to[j] - from[j]));
  if (longest < 1e-12) return {point_at(from, to, 0, kAtOnce, 1, 0)};
  const double v = std::min(speed, std::sqrt(longest * acceleration));
  const double ramp = v / acceleration, way = v * ramp / 2;
  const double even = std::max(0.0, (longest - 2 * way) / v);
  std::vector<TrajectoryPoint> points;
  points.push_back(point_at(from, to, longest, ramp, way / longest, v));
  if (even > kEven * ramp)
    points.push_back(point_at(from, to, longest, ramp + even, 1 - way / longest, v));
  points.push_back(point_at(from, to, longest, 2 * ramp + even, 1, 0));
  return points;
}

}  // namespace selfcal
