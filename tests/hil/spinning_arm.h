// Six joints that turn on and on, written to the bus at 1 kHz, and a line that is driven at random
// moments: a robot whose truth at any moment is one formula, in a process of its own.
#pragma once

#include <sys/types.h>

#include <Eigen/Dense>

#include "io/can/settings.h"
#include "tests/hil/wiring.h"

namespace selfcal {

/// q_j(t) = v_j s + A sin(w s + j), s the time since `began`: 0.36 to 2.6 rad/s, at most 2 rad/s^2.
struct Spin {
  Nanoseconds began = 0;
  Eigen::VectorXd q(Nanoseconds t) const;
  Eigen::VectorXd dq(Nanoseconds t) const;
};

/// The joints' frames with SYNC, as the robot writes and the service reads them.
CanSettings spinning_settings(const std::string& interface);

struct SpinningArmOptions {
  Nanoseconds cycle = kMillisecond;             ///< of SYNC and the joints' frames
  Nanoseconds touch_every = 30 * kMillisecond;  ///< the line closes once in it, and opens again
  Nanoseconds closed_for = 15 * kMillisecond;   ///< less than two thirds of it
  unsigned seed = 1;
};

class SpinningArm {
 public:
  SpinningArm(const Wiring& wires, const SpinningArmOptions& options);
  ~SpinningArm();
  SpinningArm(const SpinningArm&) = delete;
  SpinningArm& operator=(const SpinningArm&) = delete;

  const Spin& truth() const { return truth_; }

 private:
  Spin truth_;
  pid_t pid_ = 0;
};

}  // namespace selfcal
