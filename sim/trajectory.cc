// s(t) = s0 + a t^2 / 2 up to t1; then s1 + v (t - t1) up to t2; then s2 + v (t - t2) - a (t -
// t2)^2 / 2 up to t3, when s stands. A stop keeps s before it and replaces what follows by braking.
#include "sim/trajectory.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kRounding = 1e-12;  // of s at the end of a move, a sum of segments that is about 1

}  // namespace

Trajectory::Trajectory(Eigen::VectorXd q) : from_(q), to_(std::move(q)) {}

Trajectory::Trajectory(Eigen::VectorXd from, Eigen::VectorXd to, double speed, double acceleration,
                       Nanoseconds start)
    : from_(std::move(from)), to_(std::move(to)), start_(start) {
  const double farthest = (to_ - from_).cwiseAbs().maxCoeff();
  if (farthest <= 0) return;
  a_ = acceleration / farthest;
  v_ = std::min(speed / farthest, std::sqrt(a_));  // at sqrt(a) there is no level part
  t1_ = v_ / a_;
  t2_ = 1 / v_;
  t3_ = t2_ + t1_;
}

double Trajectory::s(Nanoseconds t) const {
  if (a_ == 0) return 0;
  const double time = std::clamp(seconds(t - start_), 0.0, t3_);
  const double up = std::min(time, t1_);
  double s = s0_ + a_ * up * up / 2;
  if (time > t1_) s += v_ * (std::min(time, t2_) - t1_);
  if (time > t2_) s += v_ * (time - t2_) - a_ * (time - t2_) * (time - t2_) / 2;
  return s;
}

Nanoseconds Trajectory::end() const {
  return start_ + static_cast<Nanoseconds>(std::ceil(t3_ * 1e9));
}

Nanoseconds Trajectory::when(double s_wanted) const {
  Nanoseconds low = start_, high = end();
  if (s(high) < s_wanted - kRounding) return high + 1;
  while (high - low > 1) {
    const Nanoseconds middle = low + (high - low) / 2;
    (s(middle) < s_wanted ? low : high) = middle;
  }
  return high;
}

void Trajectory::stop(Nanoseconds t) {
  const double time = seconds(t - start_);
  if (a_ == 0 || time >= t2_) return;  // standing, or braking already
  if (time < t1_) {
    v_ = a_ * std::max(time, 0.0);
    t1_ = std::max(time, 0.0);
  }
  t2_ = std::max(time, t1_);
  t3_ = t2_ + v_ / a_;
}

}  // namespace selfcal
