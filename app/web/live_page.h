// The live page: one HTML file that loads nothing but the state from its own server. Assembled when
// the program is built (page/live.cmake).
#pragma once

#include <string_view>

namespace selfcal {

std::string_view live_page();

}  // namespace selfcal
