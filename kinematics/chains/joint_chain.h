// A chain of joints as other programs describe it: where each joint stands when all are at zero,
// and about which axis it moves. The end of the chain is, by the product of exponentials,
//   X_WT(q) = exp(S_1 q_1) … exp(S_n q_n) X_WT(0)                  (Lynch, Park: Modern
//   Robotics, 4.14)
// with S_j the screw of joint j at zero; W is the chain's first link, T its last.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal {

/// A joint that has no reading of its own: variable = multiplier · (variable of the leader) +
/// offset.
struct Mimicry {
  int leader = 0;  ///< place of the leader in its chain
  double multiplier = 1, offset = 0;
};

struct ChainJoint {
  std::string name;
  serial::Motion motion = serial::Motion::revolute;        ///< never fixed
  Eigen::Isometry3d X_WJ = Eigen::Isometry3d::Identity();  ///< with all joints at zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();         ///< unit, in J
  /// In W, which of the two ways x of its frame points; without, that which turns less against the
  /// frame before.
  std::optional<Eigen::Vector3d> x = {};
  double lower = 0, upper = 0;  ///< rad or m; equal: not limited
  std::optional<Mimicry> mimicry;
  std::optional<double> mass;  ///< kg, of all that it carries up to the next joint
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< m, of this mass, in J
};

/// A fixed joint of the chain, which a robot file may merge or keep.
struct FixedJoint {
  std::string name;                                        ///< that of no other
  size_t behind = 0;                                       ///< how many moving joints are before it
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();  ///< with all joints at zero
};

struct JointChain {
  std::string name;
  std::vector<ChainJoint> joints;  ///< from the base on
  std::vector<FixedJoint> fixed;   ///< likewise; the last of those behind the last joint is T
  Eigen::Isometry3d X_WT = Eigen::Isometry3d::Identity();  ///< with all joints at zero
};

/// The frame whose z axis is the joint's: J itself where its axis is z.
Eigen::Isometry3d axis_frame(const ChainJoint& joint);

/// What becomes of fixed joints: part of the frames before and behind them, or a whole pose each.
enum class FixedJoints { merged, kept };

/// The chain in the frames of a serial robot: the base and the tool as whole poses, a frame for
/// each joint by the common normals of neighbouring axes, by Hayati's parameter where these are
/// parallel within kParallel. A fixed joint that is kept is a whole pose: F as the chain has it,
/// but for a turn about its z and a shift along it where a moving joint follows; those before the
/// first joint and behind the last stand for the base and for the tool. Angles within 1e-10 of
/// quarter turns and lengths within 1e-11 of zero are these. The chain has a joint, and no mimicry
/// leads to itself.
serial::Model frames_of(const JointChain& chain, FixedJoints fixed = FixedJoints::merged);

/// What mimicry adds to the joint variables: coupling · readings + offset. The identity and zeros
/// where no joint mimics.
struct Coupling {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd offset;
};
Coupling coupling_of(const JointChain& chain);

inline constexpr double kParallel = 0.1;  ///< sine of the angle below which axes count as parallel
inline constexpr double kStill =
    1e-6;  ///< rad or m: the readings of a joint that has none of its own

}  // namespace selfcal
