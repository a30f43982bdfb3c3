// What a search leaves of all sets of causes that it has visited.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/evidence/candidates.h"
#include "diagnosis/evidence/hypothesis.h"

namespace selfcal {

using Cause = std::pair<std::string, std::string>;  ///< effect, at

struct Posterior {
  /// Most probable first, log_weight normalised: those that are possible, the best one with each
  /// candidate, the best of noise alone and of structure.
  std::vector<Hypothesis> hypotheses;
  std::map<std::string, double> family;
  std::map<Cause, double> cause;
  double none = 0, unknown = 0;
  double log_total = 0;  ///< log evidence over that of nothing at all
};

/// By candidate, the number of the first one of its family (effect), and of its cause (effect and
/// place).
struct CauseNumbers {
  explicit CauseNumbers(const Candidates& candidates);
  std::vector<int> family, cause;
};

/// What sets are made of: `unknown`, by structure, is 1 where it is one of no known cause.
struct Ingredients {
  const Candidates& candidates;
  const CauseNumbers& numbers;
  std::vector<char> unknown;
};

/// Of sets whose weights are logarithms of evidence times prior; these become normalised, and the
/// log of their sum is the total.
Posterior posterior_of(std::vector<CompactHypothesis>& visited, const Ingredients& of);
/// What `all` becomes with so much (0 to 1) of the probability that sets beside structure had; the
/// rest goes to those without, in proportion.
Posterior with_less_structure(const Posterior& all, double kept, const Ingredients& of);

}  // namespace selfcal
