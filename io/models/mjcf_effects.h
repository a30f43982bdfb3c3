// Those of a robot's effects that a model for MuJoCo can carry.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal {

/// A joint that gives way.
struct JointSpring {
  std::string joint;      ///< the frame that it moves
  double compliance = 0;  ///< rad/(N m), m/N; positive
};

/// What turns about the axes of a frame under a load: a link along its length to the next frame, or
/// at its origin all that is behind the last joint.
struct BodySpring {
  std::string frame;
  Eigen::Vector3d compliance = Eigen::Vector3d::Zero();  ///< rad/(N m) about x, y, z; not negative
};

/// A joint that lies where the load on it puts it, within its play.
struct DeadBand {
  std::string joint;
  double play = 0;  ///< rad or m, whole; positive
};

/// A joint that another one's reading drags along.
struct Drag {
  std::string joint, from;
  double kappa = 0;
};

struct MjcfEffects {
  std::vector<JointSpring> joints;
  std::vector<BodySpring> links, tools;
  std::vector<DeadBand> plays;
  std::vector<Drag> drags;
  std::vector<std::string> left_out;  ///< what no static model for MuJoCo has, and why

  bool carries_any() const {
    return !joints.empty() || !links.empty() || !tools.empty() || !plays.empty() || !drags.empty();
  }
};

/// What a joint moves beside its own reading, in proportion to the reading of one (11.16).
struct Following {
  std::string joint, leader, name;
  double factor = 0;
};

/// Of all joints, by coupling, gears and drags.
std::vector<Following> followings(const serial::Model& robot, const std::vector<Drag>& drags);

/// The entries of `effects` in the file of the serial robot `model`.
MjcfEffects mjcf_effects(const Node& robot, const serial::Model& model);

}  // namespace selfcal
