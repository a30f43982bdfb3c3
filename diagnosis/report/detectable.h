// The smallest effect of each kind that would have been named, and what these rows cannot test.
#pragma once

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"

namespace selfcal {

struct Diagnosis;
struct DiagnosisOptions;

/// Fills `detectable` with each cause in its best seen shape, and adds to `untestable` what
/// calibration absorbs or nothing moves.
void list_detectable(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                     const DataSet& data, const DiagnosisOptions& options, Diagnosis& into);

}  // namespace selfcal
