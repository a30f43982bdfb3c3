// What must hold before a function is called. Where it does not, the program is wrong: it stops at
// once and says where, instead of going on with what cannot be.
#pragma once

#include <source_location>
#include <string_view>

namespace selfcal {

/// Writes `what` and the place to standard error and aborts.
[[noreturn]] void broken(std::string_view what, const std::source_location& where);

/// Aborts, naming the caller's place, unless `holds`; `what` says what should have held.
inline void expects(bool holds, std::string_view what,
                    const std::source_location& where = std::source_location::current()) {
  if (!holds) broken(what, where);
}

}  // namespace selfcal
