// Two data sets of one robot: what changed from the first to the second.
//
// Both are explained by one geometry, and each thing that may have changed (a joint's zero, the
// base, the probe, a surface) gets columns of its own on the rows of the second. Which of them are
// needed is weighed as causes are. A zero that shifted between two sessions is seen here, where it
// is invisible within either.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"

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

/// Why a data set of `one` cannot be compared with one of `other`, to follow its name; empty when
/// it can.
std::string incomparable(const Robot& one, const Robot& other);

/// What two data sets are of: one machine in two sessions, or two machines, whose links and gears
/// may differ as well.
enum class Between { sessions, machines };

/// `before` and `after` are of one robot file (see incomparable). Sets of one name are one surface
/// or instrument.
Comparison compare(const std::shared_ptr<const Robot>& robot, const DataSet& before,
                   const DataSet& after, Between between = Between::sessions,
                   const DiagnosisOptions& options = {}, const Progress& progress = {});

}  // namespace selfcal
