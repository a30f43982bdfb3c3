// A set of causes that may explain the rows, and what a search leaves of many.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace selfcal {

/// One hypothesis: candidates (ascending) and a structure (0: none).
struct Hypothesis {
  std::vector<int> candidates;
  int structure = 0;
  double log_weight = 0;      ///< evidence times prior, summed over sizes
  std::vector<double> sizes;  ///< most probable, by candidate
};

/// Answers that stand where an effect is named: what calibration leaves is noise, or structure that
/// no known effect explains.
inline constexpr const char kNone[] = "none", kUnknown[] = "unknown";
inline bool names_effect(std::string_view answer) { return answer != kNone && answer != kUnknown; }

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

}  // namespace selfcal
