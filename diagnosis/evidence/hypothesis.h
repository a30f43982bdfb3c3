// A set of causes that may explain the rows.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "diagnosis/constants.h"
#include "kinematics/expects.h"

namespace selfcal {

/// One hypothesis: candidates (ascending) and a structure (0: none).
struct Hypothesis {
  std::vector<int> candidates;
  int structure = 0;
  double log_weight = 0;      ///< evidence times prior, summed over sizes
  std::vector<double> sizes;  ///< most probable, by candidate
};

/// One as a search holds many of them: of so many candidates at most, ascending, in one place.
struct CompactHypothesis {
  int count = 0, structure = 0;
  std::array<int, kDiagnosis.evidence.most_together> candidates{};
  std::array<float, kDiagnosis.evidence.most_together> sizes{};  ///< powers of two
  double log_weight = 0;
  std::optional<bool> impossible = {};  ///< no machine can have it; without a value: not asked

  std::span<const int> all() const { return {candidates.data(), static_cast<std::size_t>(count)}; }
  auto key() const { return std::tie(count, structure, candidates); }
  void add(int candidate, double size) {
    int at = count++;
    for (; at > 0 && candidates[at - 1] > candidate; --at) {
      candidates[at] = candidates[at - 1];
      sizes[at] = sizes[at - 1];
    }
    candidates[at] = candidate;
    sizes[at] = static_cast<float>(size);
  }
  Hypothesis hypothesis() const {
    return {{candidates.begin(), candidates.begin() + count},
            structure,
            log_weight,
            {sizes.begin(), sizes.begin() + count}};
  }
};

inline CompactHypothesis compact(const Hypothesis& h) {
  CompactHypothesis same{.structure = h.structure};
  expects(h.candidates.size() <= same.candidates.size(), "a set as a search visits it");
  for (std::size_t i = 0; i < h.candidates.size(); ++i) same.add(h.candidates[i], h.sizes[i]);
  same.log_weight = h.log_weight;
  return same;
}

/// Answers that stand where an effect is named: what calibration leaves is noise, or structure that
/// no known effect explains.
inline constexpr const char kNone[] = "none", kUnknown[] = "unknown";
inline bool names_effect(std::string_view answer) { return answer != kNone && answer != kUnknown; }

}  // namespace selfcal
