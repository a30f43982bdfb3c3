// The part of what a robot can do where its end position counts.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "kinematics/description.h"

namespace selfcal {

/// A box of end positions in the world, in which the tool points within a cone. Without a box, the
/// region that the rows span.
struct Workspace {
  std::optional<Eigen::AlignedBox3d> box;               ///< m
  Eigen::Vector3d approach = Eigen::Vector3d::UnitZ();  ///< unit, the cone's axis (world)
  std::optional<double> cone;  ///< rad, half the opening; nothing: the tool points anywhere
};

/// {box: [[x, y, z], [x, y, z]], approach: [x, y, z], cone: RAD}
Workspace read_workspace(const Node& node, Problems& problems);

}  // namespace selfcal
