// A serial robot: a chain of frames, each placed in the one before it by
//   T = Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r)   (11.3)
// with the joint variable added to theta (revolute) or r (prismatic), and
//   joint variables = coupling diag(K) readings.                           (11.16)
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal::serial {

/// Place of a frame's parameters within its five.
enum Field { kAlpha, kD, kTheta, kR, kBeta, kFields };

enum class Motion { fixed, revolute, prismatic };

struct Frame {
  std::string name;
  Motion motion = Motion::fixed;
  Eigen::Matrix<double, kFields, 1> value, nominal;  ///< rad, m
  Eigen::Matrix<double, kFields, 1> tolerance;       ///< negative where the file is silent
  double gear = 1, gear_nominal = 1;
  double gear_tolerance = -1;  ///< negative where the file is silent: the ratio is held
  double lower = 0, upper = 0;
  std::optional<double> mass;                     ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< m, in this frame
};

struct Model {
  std::string name;
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, world frame
  std::vector<Frame> frames;             ///< from the world to the tool
  Eigen::MatrixXd coupling;              ///< joints x joints; empty when the file gives none
};

/// Reads a robot file of kind "serial"; the result is meaningless after a problem.
Model read(const Node& node, Problems& problems);
/// The file content of `model`.
Node write(const Model& model);

/// The frames as links. Frames without mass count as massless.
Mechanics mechanics(const Model& model);

/// Joint torque (N m; N for a prismatic joint) that gravity exerts on each joint variable at `q`
/// (readings).
Eigen::VectorXd gravity_torques(const Model& model, const Eigen::VectorXd& q);

/// Pose of every frame in the world at readings `q`, with the model's own values.
std::vector<Eigen::Isometry3d> frame_poses(const Model& model, const Eigen::VectorXd& q);

/// Indices of the moving frames.
std::vector<int> moving_frames(const Model& model);

/// What a person checks by eye: gravity in the first moving joint's frame, static torques.
std::vector<std::string> remarks(const Model& model);

/// Parameters in the file's order: alpha d theta r beta of each frame, then K of each joint.
std::vector<Parameter> parameters(const Model& model);

/// Order of preference of the columns (11.4.2.1) as indices into parameters().
std::vector<int> preference(const Model& model);

}  // namespace selfcal::serial
