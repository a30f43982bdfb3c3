// Who runs the program.
#pragma once

#include <string>

namespace selfcal {

/// "ana@cell": for the service's log, as the system knows us.
std::string user_at_host();

}  // namespace selfcal
