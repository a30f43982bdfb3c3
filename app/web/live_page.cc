#include "app/web/live_page.h"

extern "C" {
extern const char selfcal_live_begin[];  // NOLINT: names of the assembler's
extern const char selfcal_live_end[];
}

namespace selfcal {

std::string_view live_page() {
  // cppcheck-suppress comparePointers  // the assembler's labels are of one object
  return {selfcal_live_begin, static_cast<std::size_t>(selfcal_live_end - selfcal_live_begin)};
}

}  // namespace selfcal
