// Calibrated robots as URDF.
#pragma once

#include <string>
#include <vector>

#include "io/models/urdf.h"
#include "kinematics/chains/corrected_chain.h"

namespace selfcal {

/// A URDF, and what it does not hold of the robot.
struct UrdfText {
  std::string text;
  std::vector<std::string> left_out;
};

/// The URDF `text` (`file` in messages) with the origins of its joints, on the chain `read` from
/// it, as `corrected` has them; all else as it was. What moves the base goes into the chain's first
/// joint, what moves the tool into the last one when that is fixed. Refuses a chain that goes up
/// the tree.
Result<UrdfText> urdf_like(const std::string& text, const std::string& file, const UrdfChain& read,
                           const CorrectedChain& corrected);

/// A URDF of the robot alone: a link a frame, called after it, behind the link `world`. Its joints'
/// positions are the joint variables.
UrdfText urdf_of(const serial::Model& robot);

}  // namespace selfcal
