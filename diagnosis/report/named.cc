#include "diagnosis/report/named.h"

#include <algorithm>

namespace selfcal {

bool names(const CauseResult& verdict, const Candidate& candidate) {
  return candidate.effect == verdict.effect &&
         (verdict.where.empty() || std::ranges::count(verdict.where, candidate.at) > 0);
}

Hypothesis with_named(Hypothesis h, const CauseResult& verdict, const Candidates& all,
                      const Posterior& posterior) {
  if (!names_effect(verdict.effect)) return h;
  CauseResult one{.effect = verdict.effect};
  const auto named = [&](int c) { return names(one, all.list[static_cast<size_t>(c)]); };
  const std::vector<std::string> anywhere{""};
  for (const std::string& at : verdict.where.empty() ? anywhere : verdict.where) {
    one.where.clear();
    if (!at.empty()) one.where.push_back(at);
    if (std::ranges::any_of(h.candidates, named)) continue;
    for (const Hypothesis& other : posterior.hypotheses) {
      const auto found = std::ranges::find_if(other.candidates, named);
      if (found == other.candidates.end()) continue;
      h.candidates.push_back(*found);
      h.sizes.push_back(other.sizes[static_cast<size_t>(found - other.candidates.begin())]);
      break;
    }
  }
  return h;
}

}  // namespace selfcal
