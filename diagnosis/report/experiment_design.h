// What to measure next so that causes which these rows cannot tell apart come apart.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

struct NextSteps {
  std::vector<NextStep> steps;
  std::string why;  ///< there are none, or are not enough, and what would be; empty otherwise
};

/// For each named cause and the one most easily taken for it, and where none is named for the most
/// probable one and noise: each kind of further rows tried on paper. What a cause of the estimated
/// size would leave when explained by the other one says how sure one would then be. For structure
/// that no known effect explains: what would show of which kind it is. The best ones; never none
/// without a reason. Where `options` has possible rows, one step: those of them that tell all
/// causes that are at issue from each other.
NextSteps next_steps(const LinearisedModel& linearised, const DataSet& data,
                     const Diagnosis& diagnosis, const DiagnosisOptions& options = {});

}  // namespace selfcal
