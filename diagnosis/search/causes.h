// From the posterior of hypotheses to the causes that a person is told.
#pragma once

#include <optional>

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/kernel_domain.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Every cause with its probability, most probable first, `none` and `unknown` among them.
std::vector<CauseResult> cause_results(const LinearisedModel& linearised,
                                       const EvidenceEvaluator& evaluator,
                                       const Posterior& posterior);

/// How the rows err that the unknown explains, where one way is more probable than all others; at
/// which joint of `robot`, where one is.
std::optional<UnknownStructure> structure_of_unknown(const EvidenceEvaluator& evaluator,
                                                     const Posterior& posterior,
                                                     const Robot& robot);

/// "joint_compliance@j2", or the effect alone.
std::string label(const std::string& effect, const std::string& at);

}  // namespace selfcal
