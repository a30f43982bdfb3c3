// Calibration anew with what was found in the model.
#pragma once

#include <memory>

#include "constraints/estimation/options.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// The model's robot with what was found, at no size yet.
std::shared_ptr<const Robot> with_effects(const LinearisedModel& linearised,
                                          const Correction& found);

/// An identification of all that a robot's effects have.
Options free_effects(const Robot& robot);

/// What calibration with all that was found leaves of the rows (m, rms).
double left_with(const LinearisedModel& linearised, const DataSet& data, const Correction& found);

}  // namespace selfcal
