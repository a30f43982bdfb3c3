// Rows that scatter more than their files state.
//
// Where no effect and no structure is found in them, either the stated noise is too small or
// something unknown errs from row to row: a vibration, a slip, a beam that bends. Rows that are not
// repeated cannot tell; how far the noise is beyond what is stated says how probable either is.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

struct SetScatter {
  int set = 0;
  bool lengths = true;  ///< in m; else in rad
  double declared = 0;  ///< 1 sigma, by the file
  double found = 0;     ///< with the best explanation
  double repeats = 0;   ///< by immediate repeats alone; 0 without
};

/// Of the sets whose files state a noise, and none of the joints' readings besides.
std::vector<SetScatter> scatter_of_sets(const LinearisedModel& linearised, const DataSet& data);

/// "the rows of table scatter by 0.2 mm around the model that explains them best, and their files
/// state a noise of 0.1 mm, and their repeats differ by 0.19 mm".
std::string scatter_in_words(const SetScatter& scatter, const DataSet& data);

/// Probability that something unknown makes the scatter, and no wrong figure of the noise, which
/// `freedom` freedoms tell: a stated noise is right to a seventh or so and now and then far off.
double unknown_by_scatter(const SetScatter& scatter, double freedom);

/// Nothing is named, no cause is worth telling, and the rows scatter too far for that: the verdict
/// becomes `unknown` with that probability, and says why.
void doubt_noise(const LinearisedModel& linearised, const DataSet& data, double freedom,
                 Diagnosis& diagnosis);

/// Rows that scatter more than stated, where the verdict does not say so; empty where none do.
std::string warning_of_scatter(const LinearisedModel& linearised, const DataSet& data,
                               const Diagnosis& diagnosis);

}  // namespace selfcal
