// What must hold before a function is called. Where it does not, the program is wrong: it stops at
// once and says where, instead of going on with what cannot be.
#pragma once

#include <string_view>

namespace selfcal {

/// A place in a source file, by default that of the call. (clang 14 reads no std::source_location.)
struct SourcePlace {
  const char* file;
  int line;
  const char* function;

  static SourcePlace here(const char* file = __builtin_FILE(), int line = __builtin_LINE(),
                          const char* function = __builtin_FUNCTION()) {
    return {file, line, function};
  }
};

/// Writes `what` and the place to standard error and aborts.
[[noreturn]] void broken(std::string_view what, const SourcePlace& where = SourcePlace::here());

/// Aborts, naming the caller's place, unless `holds`; `what` says what should have held.
inline void expects(bool holds, std::string_view what,
                    const SourcePlace& where = SourcePlace::here()) {
  if (!holds) broken(what, where);
}

}  // namespace selfcal
