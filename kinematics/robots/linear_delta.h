// A linear delta: three towers, on each a carriage, from each carriage a rod to the effector, which
// keeps its orientation (each rod stands for a parallelogram).
//
//   c_i = (radius cos angle, radius sin angle, 0) + s_i u_i,   s_i = endstop + scale reading
//   |p - c_i| = rod_i, i = 1, 2, 3;  p below the carriages;  tool = p + R tool
// u_i is z turned by the tower's tilt, R the effector's own, both rotation vectors (x, y, 0) in the
// base's axes. Radius and angle are those of the tower's line as the effector's joints see it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/robot.h"
#include "kinematics/robots/figures.h"
#include "kinematics/robots/loop_masses.h"

namespace selfcal::linear_delta {

inline constexpr int kTowers = 3;

/// Place of a tower's parameters within its seven.
enum Field { kRadius, kAngle, kRod, kEndstop, kTiltX, kTiltY, kScale, kFields };
/// Place of the other parameters, after those of the towers.
enum Other { kEffector = kFields * kTowers, kTool = kEffector + 2, kParameters = kTool + 3 };

inline int index(int tower, int field) { return kFields * tower + field; }

struct Delta : PartFigures {
  Delta() : PartFigures(kParameters) {}

  std::string name;
  std::array<double, kTowers> lower{}, upper{};  ///< of the readings; equal: none
  /// Most that a rod turns from where it points with all carriages in the middle of their readings
  /// (rad); 0: any.
  std::array<double, kTowers> swing{};
  LoopMasses masses;  ///< effector, carriages and rods
};

/// Reads a robot file of kind "linear-delta"; the result is meaningless after a problem.
Delta read(const Node& node, Problems& problems);
/// The file content of `model`.
Node write(const Delta& model);

/// Name of a tower's frame and joint: "tower1".
std::string tower_name(int tower);
/// Parameters in the file's order: those of each tower, the effector's tilt, the tool.
std::vector<Parameter> parameters(const Delta& model);
/// Order of preference of the columns as indices into parameters().
std::vector<int> preference(const Delta& model);

/// Numbers with which a tower's line and the height of its carriage are made.
struct Tower {
  Eigen::Vector3d foot, u;  ///< in the base plane; unit, along the tower
};
Tower tower(const Eigen::VectorXd& xi, int t);

/// Tilt at `at` and the place after it, as a rotation vector.
Eigen::Vector3d tilt_of(const Eigen::VectorXd& xi, int at);

/// One configuration with the loops closed.
struct ClosedLoops {
  std::array<Tower, kTowers> towers;
  Eigen::Vector3d height;    ///< s_i
  Eigen::Matrix3d carriage;  ///< column i is c_i
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d down = Eigen::Vector3d::Zero();  ///< unit, across the carriages' plane, to p
  std::string open;  ///< why there is no p, then zero; empty where it closes
};

/// The loops closed at readings `q`, `added` to the joint variables.
ClosedLoops close(const Eigen::VectorXd& xi, const std::array<Tower, kTowers>& towers,
                  const Eigen::Vector3d& q, const Eigen::Vector3d& added);

/// Readings that bring the effector's joints to `p`; nothing where a rod does not reach.
std::optional<Eigen::Vector3d> readings_at(const Eigen::VectorXd& xi, const Eigen::Vector3d& p);
/// From the middle, how far out (m) every rod still stands steeply enough: three times as far
/// across as high, the limit at which printers' firmwares begin to slow down.
double working_radius(const Eigen::VectorXd& xi);

/// What a person checks by eye.
std::vector<std::string> remarks(const Delta& model);

}  // namespace selfcal::linear_delta
