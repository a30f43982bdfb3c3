// How often noise alone would look as much like a cause, or like structure of no known one, as
// these rows do.
#pragma once

#include <vector>

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"

namespace selfcal {

/// (1 + k) / (1 + B), k of the B resamples `found` being as good as `seen`; without one as good
/// what their tail says, where there are enough of them.
double share_as_good(const std::vector<double>& found, double seen);

/// What the search finds in noise alone: the most probable cause and the best one beside it, once
/// the rows that lie far from these are put aside as they are in the search.
class NullDistribution {
 public:
  /// `resamples` times in rows with resampled signs, whole configurations at a time. `evaluator`
  /// sees the true rows again afterwards. `most_outliers`: share of the rows that may be put aside.
  NullDistribution(const LinearisedModel& linearised, EvidenceEvaluator& evaluator,
                   const Observations& data, int resamples, unsigned long long seed,
                   double most_outliers);
  explicit NullDistribution(std::vector<double> found) : found_(std::move(found)) {}

  double p_of(double found) const { return share_as_good(found_, found); }

 private:
  std::vector<double> found_;
};

/// How often residuals that are dealt out to the rows anew, each row's with a sign of its own,
/// speak as much for structure that no known effect explains, over noise alone: of what is left
/// beyond `known`, the most probable causes with such structure.
double p_of_unknown(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                    const Hypothesis& known, const Observations& data, int resamples,
                    unsigned long long seed);

/// How probable noise alone remains at least, at even odds before, where it does as well with
/// probability `p`: 1 / (1 - 1 / (e p ln p)), 0.5 from 1/e on (Sellke, Bayarri and Berger 2001).
double least_probability_of_none(double p);

}  // namespace selfcal
