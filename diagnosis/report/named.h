// What a verdict names, among all that was found.
#pragma once

#include "diagnosis/evidence/candidates.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// The candidate is of the cause's effect and at one of its places.
bool names(const CauseResult& cause, const Candidate& candidate);
bool names_any(const std::vector<CauseResult>& named, const Candidate& candidate);

/// Takes out those of several causes that close nothing of the rows kept aside, neither alone nor
/// beside the others, as long as any other does: returns them.
std::vector<CauseResult> take_idle(std::vector<CauseResult>& named);

/// `h` and what it lacks of what is named, as the most probable hypothesis has that.
Hypothesis with_named(Hypothesis h, const std::vector<CauseResult>& named, const Candidates& all,
                      const Posterior& posterior);

}  // namespace selfcal
