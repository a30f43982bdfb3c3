// What a verdict names, among all that was found.
#pragma once

#include "diagnosis/evidence/candidates.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// The candidate is of the cause's effect, at one of its places and, where the cause is something
/// that steps or something that does not, as it does.
bool names(const CauseResult& cause, const Candidate& candidate);
/// The same of an effect that was found.
bool is_of(const CauseResult& cause, const FoundEffect& found);
bool names_any(const std::vector<CauseResult>& named, const Candidate& candidate);

/// It is so many times the usual largest, by two sigma.
bool is_beyond_usual(const NamedValue& v, double times);
/// The first of its parameters that is; null where there is none.
const NamedValue* beyond_usual(const CauseResult& cause, double times);

/// A parameter far beyond what any machine has; null where there is none, and of what a person
/// moves at will. It speaks of the rows, see doubt.h.
const NamedValue* of_impossible_size(const CauseResult& cause);

/// Takes out those of several causes that close nothing of the rows kept aside, neither alone nor
/// beside the others, as long as any other does: returns them. One of an impossible size stays.
std::vector<CauseResult> take_idle(std::vector<CauseResult>& named);

/// `h` and what it lacks of what is named, as the most probable hypothesis has that.
Hypothesis with_named(Hypothesis h, const std::vector<CauseResult>& named, const Candidates& all,
                      const Posterior& posterior);

/// The base, or the instrument, that is moved from one row to the next.
bool is_moved_at_once(const CauseResult& cause);

}  // namespace selfcal
