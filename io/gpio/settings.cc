// Which line of which GPIO chip, and what its level means.

#include "io/gpio/settings.h"

#include <cerrno>
#include <charconv>
#include <cstring>

namespace selfcal {

std::string describe(const GpioSettings& settings) {
  return "line " + settings.line + (settings.chip.empty() ? "" : " of " + settings.chip);
}

int offset_of(const std::string& text) {
  int offset = -1;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, offset);
  return error == std::errc() && stopped == end && offset >= 0 ? offset : -1;
}

Failure line_failure(const GpioSettings& settings, int error) {
  std::string why = std::strerror(error);
  if (error == ENOENT) why = "there is no such chip or line";
  if (error == EACCES || error == EPERM)
    why = "not permitted: the user must be of the group that owns /dev/gpiochip*";
  if (error == EBUSY) why = "in use by another program or driver";
  if (error == ENODEV || error == ENXIO) why = "its chip is gone";
  return {kDeviceFailed, describe(settings) + ": " + why};
}

}  // namespace selfcal
