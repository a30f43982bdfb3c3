// Rows that scatter more than their files state.
//
// Where no effect and no structure is found in them, either the stated noise is too small or
// something unknown errs from row to row: a vibration, a slip, a beam that bends. How far the noise
// is beyond what is stated, and what rows that are repeated at once differ by, says how probable
// either is.
#pragma once

#include <string>
#include <vector>

#include "constraints/fitting/noise.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Of sets that state one noise and scatter alike.
struct Scatter {
  std::vector<int> sets = {};
  bool lengths = true;        ///< in m; else in rad
  double declared = 0;        ///< 1 sigma, by the file
  double found = 0;           ///< with the best explanation
  RepeatSpread repeats = {};  ///< by immediate repeats alone
};

/// Of the sets whose files state a noise, and none of the joints' readings besides; lengths and
/// angles of one set are two.
std::vector<Scatter> scatter_of_sets(const LinearisedModel& linearised, const DataSet& data);

/// "the rows of table and wall scatter by 0.2 mm around the model that explains them best, and
/// their files state a noise of 0.1 mm, and their repeats differ by 0.19 mm".
std::string scatter_in_words(const Scatter& scatter, const DataSet& data);

/// Log of how much likelier the repeats are if the noise is what the rows scatter by than if it is
/// what is stated; 0 without repeats.
double log_confirmed(const Scatter& scatter);

/// Probability that something unknown makes the scatter, and no wrong figure of the noise, which
/// `freedom` freedoms tell: a stated noise is right to a seventh or so and now and then far off.
double unknown_by_scatter(const Scatter& scatter, double freedom);

/// Nothing is named, and the rows scatter too far for that: the verdict becomes `unknown` with that
/// probability, and says why; causes that may be there as well keep theirs. Where repeats say that
/// it is noise all the same, it stays, and says so.
void doubt_noise(const LinearisedModel& linearised, const DataSet& data, double freedom,
                 Diagnosis& diagnosis);

/// Rows that scatter more than stated, where the verdict does not say so; empty where none do.
std::string warning_of_scatter(const LinearisedModel& linearised, const DataSet& data,
                               const Diagnosis& diagnosis);

}  // namespace selfcal
