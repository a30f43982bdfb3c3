// A diagnosis as a page that a person understands in a minute: one file, no script, nothing
// fetched.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/comparison/comparison.h"
#include "diagnosis/comparison/simulation.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Another data set, by its name, and what the comparison with it came to.
struct SinceBefore {
  std::string name;
  Comparison comparison;
};
struct AgainstSimulation {
  std::string name;
  Differences differences;
};

/// All that a person asked of one data set.
struct Findings {
  std::string name;  ///< the data set's
  Diagnosis diagnosis;
  std::optional<SinceBefore> since;
  std::optional<AgainstSimulation> sim;
};

std::string html_report(const Findings& findings);

}  // namespace selfcal
