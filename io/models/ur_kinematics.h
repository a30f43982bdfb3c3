// The kinematics file of Universal Robots' ROS driver, as its calibration_correction writes it:
// under `kinematics` the pose of each joint in the one before (x y z roll pitch yaw, axis z), from
// base_link_inertia on, and `hash`, which the driver compares with what the controller holds.
#pragma once

#include <string>

#include "io/result.h"
#include "kinematics/chains/corrected_chain.h"
#include "kinematics/chains/joint_chain.h"

namespace selfcal {

struct UrKinematics {
  JointChain chain;  ///< six joints; the end is the last one's frame
  std::string hash;
};

/// Refuses, with file and line, what is no such file.
Result<UrKinematics> read_ur_kinematics(const std::string& text, const std::string& file);

/// The file's text with the joints as `chain` has them.
std::string ur_kinematics_text(const JointChain& chain, const std::string& hash);

}  // namespace selfcal
