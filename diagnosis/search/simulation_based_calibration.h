// How good the diagnosis would be on sessions like this one: simulated over the user's own
// configurations and noise, with causes drawn from the priors.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"
#include "diagnosis/search/sign_flip_test.h"

namespace selfcal {

/// `null` says how much noise alone would find on these rows. `evaluator` sees the true rows again
/// afterwards.
SimulationBasedCalibration calibrate_by_simulation(const LinearisedModel& linearised,
                                                   EvidenceEvaluator& evaluator,
                                                   const NullDistribution& null,
                                                   const DiagnosisOptions& options);

/// A probability as often true as it says, by what the simulated sessions taught.
double calibrated(double probability, const SimulationBasedCalibration& simulation);

}  // namespace selfcal
