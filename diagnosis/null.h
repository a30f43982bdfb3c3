// How often noise alone would look as much like a cause as these rows do.
#pragma once

#include "diagnosis/search.h"
#include "diagnosis/view.h"

namespace selfcal {

/// (1 + k) / (1 + B): the share of B rows with resampled signs, whole configurations at a time, in
/// which the same search finds as good a cause. `bench` sees the true rows again afterwards.
double resampled_p(const View& view, Bench& bench, const Observations& data, int resamples,
                   unsigned long long seed);

/// How probable noise alone remains at least, at even odds before, where it does as well with
/// probability `p`: 1 / (1 - 1 / (e p ln p)), 0.5 from 1/e on (Sellke, Bayarri and Berger 2001).
double least_probability_of_none(double p);

}  // namespace selfcal
