// What to measure next so that causes which these rows cannot tell apart come apart.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// For the verdict and the cause most easily taken for it: each kind of further rows tried on
/// paper. What a cause of the estimated size would leave when explained by the
/// other one says how sure one would then be. The best ones, at most three; empty when nothing is
/// confounded.
std::vector<NextStep> next_steps(const LinearisedModel& view, const DataSet& data,
                                 const Diagnosis& diagnosis);

}  // namespace selfcal
