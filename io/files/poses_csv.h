// Wanted poses of the tool, one a row.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/result.h"
#include "kinematics/robot.h"

namespace selfcal {

inline constexpr std::string_view kPoseColumns = "x,y,z,qw,qx,qy,qz";

struct WantedPose {
  Location location;     ///< of the tool, in the world
  Eigen::VectorXd near;  ///< readings to stay near (rad or m); empty where the file has none
  std::string text;      ///< the cells of kPoseColumns, as the file has them, with decimal points
};

/// The rows of a CSV file with the columns x y z (m) and qw qx qy qz (unit), and q1 … of all joints
/// or of none. Refuses, with file, row and column, a file without one of these, a cell that is no
/// number, a place outside a workshop, readings that no joint has, a quaternion whose length is not
/// 1, and a file without rows.
Result<std::vector<WantedPose>> read_poses(const std::filesystem::path& path,
                                           const std::vector<Joint>& joints);

}  // namespace selfcal
