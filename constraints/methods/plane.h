// Touches of a plane that nobody wrote in a file.
#pragma once

#include <memory>

#include "constraints/methods/method.h"

namespace selfcal {

/// Touches of one unknown plane by a point, as `method: plane` alone has it.
std::shared_ptr<const Method> point_on_plane();

}  // namespace selfcal
