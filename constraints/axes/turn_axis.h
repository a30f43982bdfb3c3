// The axis of one joint from markers on a body that it turns (Angeles et al., Calibration of a
// robot by a circle of points and the polar decomposition): rotations between rows, their linear
// invariants, a point that stays.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace selfcal {

/// What was seen of a body while one joint alone turned: as many markers in every row.
struct Turning {
  std::vector<Eigen::Matrix3Xd> markers;  ///< by row, one marker a column (m)
  Eigen::VectorXd variable;               ///< by row, of the joint (rad), whole turns counted
};

/// The line about which the joint variable turns by the right hand.
struct TurnAxis {
  Eigen::Vector3d e = Eigen::Vector3d::UnitZ();  ///< unit
  Eigen::Vector3d p = Eigen::Vector3d::Zero();   ///< m, a point of it
  double weight = 0;    ///< sum of squared sines of the turns it comes from
  double off = 0;       ///< m, 1 sigma of one coordinate of a marker from its circle
  std::string problem;  ///< why there is none; empty where there is one
};

/// The rotation that minimises |R from - to|, columns being vectors (Kabsch). Where it is not
/// determined, one of those that do.
Eigen::Matrix3d rotation_onto(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// The axis of `turning`, or why it has none: a row alone, markers in a line, a turn too small, or
/// markers that turned otherwise than the variable says.
TurnAxis turn_axis(const Turning& turning);

inline constexpr double kLeastTurn = 0.05;    ///< rad, between the rows farthest apart
inline constexpr double kLeastSpread = 0.05;  ///< second extent of the markers over their first
inline constexpr double kOtherwise = 0.1;     ///< rad, of markers against the joint variable

}  // namespace selfcal
