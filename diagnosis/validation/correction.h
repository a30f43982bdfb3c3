// Effects that are put into the model, and which of them are named.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kinematics/effect_shape.h"

namespace selfcal {

struct FoundEffect {
  ShapedEffect what;
  std::vector<std::pair<std::string, double>> values = {};  ///< of its parameters, where known
  std::vector<double> sigma = {};  ///< prior 1 sigma of each parameter: the size the rows speak for
  bool named = false;              ///< of the verdict's effect, at one of its places
};

using Correction = std::vector<FoundEffect>;

/// Those that are named.
Correction named_of(const Correction& correction);

/// Entries of a robot file's `effects`, each of which says whether it is named.
std::vector<Node> entries_of(const Correction& correction);

}  // namespace selfcal
