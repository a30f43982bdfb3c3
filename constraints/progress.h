// How far a long computation is.
#pragma once

#include <functional>
#include <string_view>

namespace selfcal {

/// Called now and then with the stage in words and its share done (0 to 1). May throw, which gives
/// the computation up. Empty: nobody listens.
using Progress = std::function<void(std::string_view stage, double share)>;

}  // namespace selfcal
