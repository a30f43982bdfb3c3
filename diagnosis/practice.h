// How good the diagnosis would be on sessions like this one: simulated over the user's own
// configurations and noise, with causes drawn from the priors.
#pragma once

#include "diagnosis/diagnosis.h"
#include "diagnosis/null.h"
#include "diagnosis/view.h"

namespace selfcal {

/// `null` says how much noise alone would find on these rows. `bench` sees the true rows again
/// afterwards.
Practice practise(const View& view, Bench& bench, const NullDistribution& null,
                  const DiagnosisOptions& options);

/// A probability as often true as it says, by what practice taught.
double calibrated(double probability, const Practice& practice);

}  // namespace selfcal
