// A chain as another program describes it, with what a calibration has found.
//
// The frames of a calibrated robot are rigid on the links, and so are the joints of the chain:
//   G_j = F_j^-1 X_WJ with the maker's figures, X'_WJ = F'_j G_j with the calibrated ones.
// G_j takes the joint's axis to z of frame j, so that X'_WJ moves about the calibrated axis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/chains/joint_chain.h"

namespace selfcal {

struct CorrectedChain {
  JointChain chain;                                        ///< with the calibrated poses
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();  ///< what moves the base in W
  std::vector<std::string> left_out;  ///< corrections that are not in it, and why
  std::string problem;                ///< why the robot is not that of the chain; empty where it is
};

/// `original` with the corrections of `robot`, whose maker's figures must be those of the chain:
/// the same kinds of joints in the same order, each axis where the chain has it (to kSameAxis), the
/// same coupling. The robot's world is the chain's, or that turned by half a turn about z (a UR's
/// base); of another world, and of another tool than the chain's end, the corrections are left out.
CorrectedChain corrected_chain(const JointChain& original, const serial::Model& robot);

inline constexpr double kSameAxis = 1e-4;  ///< m, rad: digits that a table of figures may lose

}  // namespace selfcal
