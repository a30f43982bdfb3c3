// How often noise alone would look as much like a cause as these rows do.
#pragma once

#include <vector>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/search.h"

namespace selfcal {

/// What EvidenceEvaluator::best_found() finds in noise alone.
class NullDistribution {
 public:
  /// `resamples` times in rows with resampled signs, whole configurations at a time. `bench` sees
  /// the true rows again afterwards.
  NullDistribution(const LinearisedModel& view, EvidenceEvaluator& bench, const Observations& data,
                   int resamples, unsigned long long seed);
  explicit NullDistribution(std::vector<double> found) : found_(std::move(found)) {}

  /// (1 + k) / (1 + B), k of its B resamples being as good as `found`.
  double p_of(double found) const;

 private:
  std::vector<double> found_;
};

/// How probable noise alone remains at least, at even odds before, where it does as well with
/// probability `p`: 1 / (1 - 1 / (e p ln p)), 0.5 from 1/e on (Sellke, Bayarri and Berger 2001).
double least_probability_of_none(double p);

}  // namespace selfcal
