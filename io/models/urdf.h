// URDF: the chain from one link to another, as urdfdom reads it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/result.h"
#include "kinematics/chains/joint_chain.h"

namespace selfcal {

/// Which chain of the tree is meant.
struct UrdfEnds {
  std::string base;  ///< empty: the root
  std::string tip;   ///< empty: the only link that carries no other
};

/// One joint of the URDF between base and tip.
struct UrdfStep {
  std::string joint;                                       ///< as the URDF calls it
  bool moves = false;                                      ///< else it is fixed
  bool reversed = false;                                   ///< its child is nearer to the base
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();  ///< its child link, all joints at zero
};

struct UrdfChain {
  JointChain chain;                  ///< W is the base, T the tip; with the fixed joints
  std::vector<UrdfStep> steps;       ///< from the base to the tip
  UrdfEnds ends;                     ///< as found
  std::vector<std::string> notices;  ///< what a person should know
};

/// The chain between `ends` in the URDF `text`; `file` stands for it in messages. Masses off the
/// chain count with the link that carries them, their joints at zero. Names of joints lose what a
/// robot file does not allow in them. Refuses, with file and line: what urdfdom refuses, xacro that
/// nobody has run, ends that are not there or not one, joints on the chain that are neither
/// revolute, prismatic nor fixed, an axis of no length, mimicry of a joint off the chain or in a
/// circle, and a chain without a moving joint.
Result<UrdfChain> read_urdf(const std::string& text, const std::string& file, const UrdfEnds& ends);

}  // namespace selfcal
