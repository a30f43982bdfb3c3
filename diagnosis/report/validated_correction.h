// How far the gap closes: by what is named, by each of it alone and beside the rest, by everything
// found.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Fills the gap, the shares of what `into` names, the model with everything found, and what is to
/// be said of these. `linearised` ends up with more rows and their noise; `freedom` is of the noise
/// alone, in the rows that were weighed for the name.
void validate_correction(LinearisedModel& linearised, double freedom, const Posterior& posterior,
                         const DataSet& data, const DiagnosisOptions& options, Diagnosis& into);

/// The validation rows of the same, and nothing else; `of` has the name.
std::vector<ValidationRow> validation_rows(LinearisedModel& linearised, double freedom,
                                           const Posterior& posterior, const DataSet& data,
                                           const DiagnosisOptions& options, Diagnosis& of);

}  // namespace selfcal
