// A URDF as urdfdom reads it.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <string>

#include "io/models/urdf_lines.h"

namespace selfcal {

/// The tree of links and joints of `text`, with its root, or why it is none, by what urdfdom says
/// and the lines that this is of.
Result<urdf::ModelInterfaceSharedPtr> urdf_tree(const std::string& text, const UrdfLines& lines);

}  // namespace selfcal
