// A tracker's rows, and a line of the budget of the uncertainty.
#pragma once

#include <string>
#include <vector>

#include "tests/recovery/session.h"

namespace selfcal::recovery {

inline std::vector<SetPart> tracked(int rows) {
  return {{"tracker", entry({{"method", "position"}}), rows}};
}

/// Of a source (m); negative where the budget has none of that name.
inline double budget(const Solution& solution, const std::string& source) {
  for (const BudgetLine& line : solution.uncertainty.budget)
    if (line.source == source) return line.sigma;
  return -1;
}

}  // namespace selfcal::recovery
