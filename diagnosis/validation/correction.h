// Effects that are put into the model, and which of them are named.
#pragma once

#include <string>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

/// One entry of a robot file's `effects`.
struct FoundEffect {
  Node entry;
  std::vector<double> sigma = {};  ///< prior 1 sigma of each parameter: the size the rows speak for
  bool named = false;              ///< of the verdict's effect, at one of its places
};

using Correction = std::vector<FoundEffect>;

/// Those that are named.
Correction named_of(const Correction& correction);

/// Entries of a robot file, each of which says whether it is named.
std::vector<Node> entries_of(const Correction& correction);

}  // namespace selfcal
