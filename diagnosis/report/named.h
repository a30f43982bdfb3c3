// What a verdict names, among all that was found.
#pragma once

#include "diagnosis/findings.h"

namespace selfcal {

/// The candidate is of the verdict's effect and at one of its places.
bool names(const CauseResult& verdict, const Candidate& candidate);

/// `h` and what it lacks of what the verdict names, as the most probable hypothesis has that.
Hypothesis with_named(Hypothesis h, const CauseResult& verdict, const Candidates& all,
                      const Posterior& posterior);

}  // namespace selfcal
