// What others ask of touches of planes.
#pragma once

#include <memory>

#include "constraints/methods/method.h"

namespace selfcal {

/// Touches of one unknown plane by a point, as `method: plane` alone has it.
std::shared_ptr<const Method> point_on_plane();

/// Of the ball that touches the planes of `method` (m); 0 of a point, and of other methods.
double probe_radius(const Method& method);

}  // namespace selfcal
