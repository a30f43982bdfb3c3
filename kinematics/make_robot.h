// A robot from its file, of any kind that robots.def lists.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// The robot that `node` describes, by its `kind` (see robots.def). Null after a problem.
std::unique_ptr<Robot> make_robot(const Node& node, Problems& problems);
/// The kinds that make_robot knows.
std::vector<std::string_view> robot_kinds();

}  // namespace selfcal
