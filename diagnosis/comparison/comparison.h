// What changed between two data sets of one robot, and what the two are of.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/findings.h"

namespace selfcal {

struct Change {
  /// "zero_shift"; between sessions "fixture_shift", "base_moved", "probe_changed"; between
  /// machines "placed_elsewhere", "geometry_differs"
  std::string effect;
  std::string where;  ///< a joint, a set, "base", "probe", a parameter
  double probability = 0;
  std::vector<NamedValue> values;  ///< second minus first
};

struct Comparison {
  double none = 0;              ///< probability that nothing did
  double unknown = 0;           ///< of structure beyond any change, in one of them or in both
  std::vector<Change> changes;  ///< most probable first
  std::string why;              ///< in a sentence
};

/// What two data sets are of: one machine in two sessions, or two machines, whose links and gears
/// may differ as well.
enum class Between { sessions, machines };

}  // namespace selfcal
