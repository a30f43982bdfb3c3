#include "kinematics/expects.h"

#include <cstdio>
#include <cstdlib>

namespace selfcal {

void broken(std::string_view what, const SourcePlace& where) {
  std::fprintf(stderr, "selfcal: a bug: expected that %.*s (%s:%d, %s)\n",
               static_cast<int>(what.size()), what.data(), where.file, where.line, where.function);
  std::abort();
}

}  // namespace selfcal
