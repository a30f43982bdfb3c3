// A straight joint move in time: along q(s) = from + s (to - from), s from 0 to 1, with a trapezoid
// of speed; it may be stopped on the way.
#pragma once

#include <Eigen/Dense>

#include "io/ports.h"

namespace selfcal {

class Trajectory {
 public:
  /// Standing at `q`.
  explicit Trajectory(Eigen::VectorXd q);
  /// `speed` and `acceleration` are those of the joint that moves farthest (rad/s, rad/s^2).
  Trajectory(Eigen::VectorXd from, Eigen::VectorXd to, double speed, double acceleration,
             Nanoseconds start);

  double s(Nanoseconds t) const;
  Eigen::VectorXd q(Nanoseconds t) const { return at(s(t)); }
  Eigen::VectorXd at(double s) const { return from_ + s * (to_ - from_); }
  /// When the move ends.
  Nanoseconds end() const;
  /// First moment at which s is reached; end() + 1 when a stop comes first.
  Nanoseconds when(double s) const;
  /// Brakes from `t` on.
  void stop(Nanoseconds t);

 private:
  Eigen::VectorXd from_, to_;
  Nanoseconds start_ = 0;
  // s over time (s): up to t1 with +a, up to t2 at v, up to t3 with -a.
  double s0_ = 0, a_ = 0, v_ = 0;
  double t1_ = 0, t2_ = 0, t3_ = 0;
};

}  // namespace selfcal
