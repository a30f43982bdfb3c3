// How often noise alone would look as much like a cause as these rows do.
#pragma once

#include "diagnosis/search.h"
#include "diagnosis/view.h"

namespace selfcal {

/// (1 + k) / (1 + B): the share of B rows with resampled signs, whole configurations at a time, in
/// which the same search finds as good a cause. `bench` sees the true rows again afterwards.
double resampled_p(const View& view, Bench& bench, const Observations& data, int resamples,
                   unsigned long long seed);

}  // namespace selfcal
