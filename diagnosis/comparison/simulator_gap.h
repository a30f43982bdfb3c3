// How far a simulator is from the machine: the residual of the machine's rows with the tool where
// the simulator puts it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// Row by row where the simulator has the tool in its world; nothing where it has no answer.
using ToolPoses = std::vector<std::optional<Location>>;

struct SimulatorGap {
  double rms = 0;                 ///< m, of the rows that judge
  int rows = 0;                   ///< of these
  bool kept_aside = true;         ///< none of them placed an instrument or a surface
  std::vector<std::string> sets;  ///< names of those that cannot be judged so
};

/// `tool` without an answer at the rows that are false readings: no simulator explains one.
ToolPoses without_false_rows(ToolPoses tool, const std::vector<Outlier>& outliers);

/// Nuisance parameters of each set (an instrument's frame, a target, a plane) are fitted to its
/// `fit` rows, the `check` rows judge; a set that has only one kind is judged by what it has. Sets
/// whose rows hang together (pairs, groups, a reference to another set) or measure no length are
/// named.
SimulatorGap simulator_gap(const DataSet& data, const ToolPoses& tool);

}  // namespace selfcal
