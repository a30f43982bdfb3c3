#include "kinematics/expects.h"

#include <cstdio>
#include <cstdlib>

namespace selfcal {

void broken(std::string_view what, const std::source_location& where) {
  std::fprintf(stderr, "selfcal: a bug: expected that %.*s (%s:%u, %s)\n",
               static_cast<int>(what.size()), what.data(), where.file_name(), where.line(),
               where.function_name());
  std::abort();
}

}  // namespace selfcal
