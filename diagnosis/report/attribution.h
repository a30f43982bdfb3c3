// Where the gap lies: the squared residual that geometry leaves, shared out by joint, set, region
// of the cell and time.
#pragma once

#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// By joint: what effects at it explain when all joints may have some. By set, region and time:
/// what stands there beyond the noise.
Where attribution(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                  const DataSet& data);

}  // namespace selfcal
