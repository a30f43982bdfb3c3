// What a search knows of an effect beside its linear parameters; text only where a file or an
// effect is made of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

/// Given and not estimated; what an effect does not know is left as it is.
struct EffectShape {
  std::optional<double> moment = {};    ///< s, from which it is there
  std::optional<double> settle = {};    ///< s, in which it settles
  std::optional<double> lag = {};       ///< s, by which it follows its cause
  std::optional<double> mass = {};      ///< kg, that hangs on the tip
  std::vector<double> waves = {};       ///< a turn
  std::vector<double> half_waves = {};  ///< in all of the rows' time
  bool lumps = false;                   ///< of masses that are not known
  bool tool = false, base = false;      ///< takes part
  std::string by = {}, from = {};       ///< what drives it; the joint that it comes from
  bool operator==(const EffectShape&) const = default;
};

struct ShapedEffect {
  std::string effect, at;  ///< at is empty for the whole robot
  EffectShape shape = {};
};

/// Of a robot file's `effects`.
Node entry_of(const ShapedEffect& effect);

}  // namespace selfcal
