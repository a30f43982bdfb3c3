// Rows at one point that nobody wrote in a file.
#pragma once

#include <memory>

#include "constraints/methods/method.h"

namespace selfcal {

/// Rows of a group share the endpoint's position, as `method: position-constraint` alone has it.
std::shared_ptr<const Method> shared_point();

}  // namespace selfcal
