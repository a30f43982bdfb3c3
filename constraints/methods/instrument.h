// Which sets are rows of one kind of instrument, and so have one noise.
#pragma once

#include <string_view>
#include <tuple>

#include "constraints/methods/data_set.h"

namespace selfcal {

/// Method and stated noises (m, rad).
using Instrument = std::tuple<std::string_view, double, double>;

inline Instrument instrument_of(const Set& set) {
  return {set.method->name(), set.noise, set.noise_angle};
}

}  // namespace selfcal
