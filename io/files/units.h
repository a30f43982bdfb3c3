// Units that other programs' files are in, to SI.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace selfcal {

enum class Dimension {
  none,
  angle,
  length,
  angular_speed,
  speed,
  force,
  torque,
  temperature,  ///< degrees Celsius
  time,
};

/// A number in the unit times `factor` plus `offset` is in SI, a temperature in degrees Celsius.
struct Unit {
  double factor = 1, offset = 0;
};

/// The unit that is written so ("mm", "deg/s"); nothing where no unit of the dimension is.
std::optional<Unit> unit_of(std::string_view text, Dimension dimension);

/// How the units of a dimension are written: "rad, deg"; empty for `none`.
std::string units_in_words(Dimension dimension);

}  // namespace selfcal
