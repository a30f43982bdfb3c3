// Which of the causes are named, from their probabilities and from how often noise does as well.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// What is said where no cause is named: `none`, or `unknown` where that is more probable than not.
CauseResult without_cause(const Posterior& posterior);

/// What is named: see DiagnosisOptions::name_below_none. Of several causes that are more probable
/// than not the largest; `unknown` where more is left after all that is found than that explains,
/// and where none is more probable than not and structure of no known cause is.
CauseResult named_cause(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                        const Posterior& posterior, const std::vector<CauseResult>& causes,
                        const DiagnosisOptions& options);

/// How often noise does as well: as a known cause, and as structure of no known one.
struct ByNoise {
  double known = 1, unknown = 1;
};

/// `named` where the rows bear it: where noise does as well too often, there is `none` or, without
/// a known cause, structure.
CauseResult decided(CauseResult named, const Posterior& posterior, const ByNoise& p,
                    const DiagnosisOptions& options);

/// `verdict`, or none where a cause is named and `none` among the calibrated `causes` is as
/// probable as no named cause may have it.
CauseResult unless_none(CauseResult verdict, const std::vector<CauseResult>& causes,
                        const DiagnosisOptions& options);

/// How often it stepped at that place: moments of which the next is near are of one step.
std::ptrdiff_t steps_at(const CauseResult& cause, const std::string& at);

/// Of the probability of structure, what is left where noise shows as much in `p` of cases: all of
/// it up to `name_below_p`, none from no_structure on, in between by the logarithm.
double share_of_structure(double p, double name_below_p);

/// The causes; each that is probable and not sure is `together` what it and those of its
/// look-alikes are that are not sure themselves.
std::vector<CauseResult> with_look_alikes(const LinearisedModel& linearised,
                                          const Posterior& posterior,
                                          std::vector<CauseResult> causes);

/// What is named beside a verdict, which comes first: each known cause that is sure, or that is
/// probable and sure with its look-alikes (`together`), none of which is named before; the largest
/// first. None where the verdict is `none`.
std::vector<CauseResult> sure_causes(const std::vector<CauseResult>& causes,
                                     const CauseResult& verdict, const ByNoise& p,
                                     const DiagnosisOptions& options);

/// Where structure of no known cause is probable, the list of causes lacks one, and those on it are
/// the less sure: theirs among `causes`, `named` and of the verdict are lowered for it, by the less
/// the less of the gap what is named leaves (`left`, a share); and by a twentieth throughout, for
/// what no list has may look like what one has. Then the larger leads.
void allow_for_the_unknown(std::vector<CauseResult>& causes, CauseResult& verdict,
                           std::vector<CauseResult>& named, double left);

/// The verdict is `unknown` where that is surer than its cause, and more of the gap is `left` than
/// closed or the cause is not more probable than not.
void let_the_larger_lead(const std::vector<CauseResult>& causes, double left, CauseResult& verdict);

/// What steps again and again at one place is as often something that wanders, or comes and goes,
/// and looks like it: so much of its probability is the unknown's, among `causes`, `named` and of
/// the verdict, which another that is named leads then, or the unknown where that is surer.
void doubt_repeated_steps(std::vector<CauseResult>& causes, CauseResult& verdict,
                          std::vector<CauseResult>& named);

/// Where the rows that no choice has seen are left plainly beyond their noise with what is named,
/// none of it is surer than the most that it may close of the gap, and what it leaves is unknown.
void bound_by_what_is_left(const Gap& gap, std::vector<CauseResult>& causes, CauseResult& verdict,
                           std::vector<CauseResult>& named);

/// Of named causes as probable as the verdict's the one leads that closes the largest part of the
/// gap, where it is plainly larger: on average, alone and beside the others.
void let_the_larger_share_lead(CauseResult& verdict, std::vector<CauseResult>& named);

/// The verdict becomes `unknown`, of this probability at least; the others give way in proportion.
void say_unknown(double probability, std::vector<CauseResult>& causes, CauseResult& verdict);

/// One probability for one thing: that of `none` among `causes` becomes the verdict's where that is
/// none, the others' give way in proportion; then the verdict has that of its entry.
void agree(std::vector<CauseResult>& causes, CauseResult& verdict);

}  // namespace selfcal
