// Which line of which GPIO chip, and what its level means.
#pragma once

#include <string>

#include "io/result.h"

namespace selfcal {

enum class GpioBias : std::uint8_t { as_is, pull_up, pull_down, disabled };

struct GpioSettings {
  std::string chip;  ///< "gpiochip0", a path or a label; empty: the line is found by its name
  std::string line;  ///< name, or its offset on the chip
  GpioBias bias = GpioBias::as_is;
  bool active_low = false;  ///< closed when the level is low
};

/// "line probe of gpiochip0".
std::string describe(const GpioSettings& settings);

/// The offset that `text` is, or -1 when it is a name.
int offset_of(const std::string& text);

/// Why the line could not be had, from errno: "line 3 of gpiochip0: no such chip or line".
Failure line_failure(const GpioSettings& settings, int error);

}  // namespace selfcal
