// From the posterior of hypotheses to the causes that a person is told.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Every cause with its probability, most probable first, `none` and `unknown` among them.
std::vector<CauseResult> cause_results(const LinearisedModel& view, const EvidenceEvaluator& bench,
                                       const Posterior& posterior);

/// What is said where no cause is named: `none`, or `unknown` where that is more probable than not.
CauseResult without_cause(const Posterior& posterior);

/// What is named: see DiagnosisOptions::name_below_none. Of several causes that are more probable
/// than not the largest; `unknown` where much is left after all of these.
CauseResult named_cause(const LinearisedModel& view, const EvidenceEvaluator& bench,
                        const Posterior& posterior, const std::vector<CauseResult>& causes,
                        const DiagnosisOptions& options);

/// `named` where the rows bear it: noise does as well with probability `p`, and then there is
/// `none` or, without a known cause, structure.
CauseResult decided(CauseResult named, const Posterior& posterior, double p,
                    const DiagnosisOptions& options);

/// The verdict in a sentence or two.
std::string verdict_in_words(const Diagnosis& diagnosis);

/// "joint_compliance@j2", or the effect alone.
std::string label(const std::string& effect, const std::string& at);

}  // namespace selfcal
