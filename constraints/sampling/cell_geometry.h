// Places in the cell as people write them in files: surfaces, patches, sockets.
#pragma once

#include <string>
#include <vector>

#include "constraints/sampling/configurations.h"
#include "kinematics/description.h"

namespace selfcal {

/// A flat surface, known well or roughly.
struct Surface {
  Eigen::Vector3d point, normal;  ///< m; unit, outwards
};

/// A direction [x, y, z] of any length but zero, made unit; a problem when missing.
Eigen::Vector3d read_unit(Fields& fields, std::string_view key);
/// {point: [x, y, z], normal: [x, y, z]}
Surface read_surface(const Node& node, const std::string& what, Problems& problems);
/// {center: [x, y, z], radius: R}
Patch read_patch(const Node& node, const std::string& what, Problems& problems);
/// [[x, y, z] or [x, y, z, qw, qx, qy, qz], ...]
std::vector<Location> read_places(const Node& node, const std::string& what, Problems& problems);

}  // namespace selfcal
