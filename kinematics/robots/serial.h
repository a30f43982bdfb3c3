// A serial robot: a chain of frames, each placed in the one before it by
//   T = Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r)   (11.3)
// with the joint variable added to theta (revolute) or r (prismatic), and
//   joint variables = coupling diag(K) readings.                           (11.16)
// A fixed frame may be a whole pose instead,
//   T = Trans(x, y, z) R_0 exp(rx, ry, rz),   R_0 = Rot(z, yaw) Rot(y, pitch) Rot(x, roll)
// with R_0 as its maker says, so that rx ry rz are small rotations about the frame's own axes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal::serial {

/// Place of a frame's parameters within its five.
enum Field { kAlpha, kD, kTheta, kR, kBeta, kFields };
/// Place of a whole pose's parameters within its six.
enum PoseField { kX, kY, kZ, kRx, kRy, kRz, kPoseFields };

enum class Motion { fixed, revolute, prismatic };

inline constexpr double kLinkTolerance = 2.0e-3;   ///< m or rad, where the file is silent
inline constexpr double kPlacedTolerance = 50e-3;  ///< the same of base and tool frames

struct Frame {
  std::string name;
  Motion motion = Motion::fixed;
  bool whole = false;  ///< a whole pose, of a fixed frame
  Eigen::VectorXd value = Eigen::VectorXd::Zero(kFields), nominal = value;  ///< rad, m
  Eigen::VectorXd tolerance =
      Eigen::VectorXd::Constant(kFields, -1);  ///< negative where the file is silent
  /// Roll, pitch and yaw of a whole pose as the file has them, and the maker's: R(rpy) = R_0 exp.
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero(), rpy_nominal = rpy;
  double gear = 1, gear_nominal = 1;
  double gear_tolerance = -1;  ///< negative where the file is silent: the ratio is held
  double lower = 0, upper = 0;
  std::optional<double> mass;                     ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< m, in this frame
  int fields() const { return static_cast<int>(value.size()); }
};

struct Model {
  std::string name;
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, world frame
  bool standard = false;                 ///< the file has a standard DH table, turned into frames
  std::vector<Frame> frames;             ///< from the world to the tool
  Eigen::MatrixXd coupling;              ///< joints x joints; empty when the file gives none
  std::optional<double> mass;            ///< kg, of the whole robot, where frames give none
  double payload = 0;                    ///< kg, that it may carry
};

/// What the parameters of a frame are called, in their order: of a whole pose or of five numbers.
std::span<const char* const> field_names(bool whole);
bool is_angle(const Frame& frame, int field);
/// Gives a frame its parameters; the roll, pitch and yaw of a whole pose follow.
void set_values(Frame& frame, const Eigen::VectorXd& values);
/// Where the frame's values put it in the one before, with `variable` added to theta or r.
Eigen::Isometry3d pose_in_parent(const Frame& frame, double variable);

/// Reads a robot file of kind "serial"; the result is meaningless after a problem.
Model read(const Node& node, Problems& problems);
/// The file content of `model`.
Node write(const Model& model);

/// With the masses and centres that are usual along the links of a robot of `mass` and `payload`,
/// where the file gives the whole only; otherwise the same.
Model with_usual_masses(Model model);

/// The frames as links. Frames without mass count as massless; where all are and the whole robot's
/// is known, those of with_usual_masses.
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

/// Parameters in the file's order: alpha d theta r beta of each frame, or x y z rx ry rz of a whole
/// pose, then K of each joint.
std::vector<Parameter> parameters(const Model& model);

/// Index of the first parameter of each frame, and behind the last that of the first joint's K.
std::vector<int> first_parameters(const Model& model);

/// Order of preference of the columns (11.4.2.1) as indices into parameters().
std::vector<int> preference(const Model& model);

}  // namespace selfcal::serial
