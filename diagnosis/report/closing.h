// How far the gap closes: by what is named, by each of it alone and beside the rest, by everything
// found.
#pragma once

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Fills the gap, the shares of what `into` names, the model with everything found, and what is to
/// be said of these. `view` ends up with more rows and their noise; `bench` looks at the rows that
/// were weighed for the name.
void close_gap(LinearisedModel& view, const EvidenceEvaluator& bench, const Posterior& posterior,
               const DataSet& data, const DiagnosisOptions& options, Diagnosis& into);

}  // namespace selfcal
