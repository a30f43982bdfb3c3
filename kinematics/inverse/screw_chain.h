// A serial robot as the screws of its joints: with t = gear q and X_0 the endpoint's location at
// zero readings,
//   X(q) = T_1(t_1) … T_n(t_n) X_0,
// T_j a turn about, or a shift along, the line of joint j as it lies at zero readings (Murray, Li
// and Sastry, A mathematical introduction to robotic manipulation, 3.2). The same machine as
// Robot::locate has, one configuration at a time, without the heap.
#pragma once

#include <array>
#include <optional>

#include "kinematics/robot.h"

namespace selfcal {

struct Screw {
  bool turns = true;
  double gear = 1;  ///< rad or m per unit of the reading, above 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(), point = Eigen::Vector3d::Zero();
};

struct ScrewChain {
  static constexpr int kMostJoints = 16;

  int joints = 0;
  std::array<Screw, kMostJoints> screw;
  Location zero;  ///< X_0

  /// The endpoint at `t`, the joints' variables (rad, m) from those at zero readings on.
  Location at(const double* t) const;
};

/// T_j(t) of a screw.
Location moved_by(const Screw& screw, double t);
Location inverse_of(const Location& X);

/// Of the robot with parameters `xi`; nothing of one with loops, with effects, with joints that
/// move each other or with more of them than kMostJoints.
std::optional<ScrewChain> screw_chain(const Robot& robot, const Eigen::VectorXd& xi);

}  // namespace selfcal
