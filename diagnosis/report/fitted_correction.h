// A robot with the effects of a correction, identified from the `fit` rows.
#pragma once

#include <memory>

#include "constraints/equations/equations.h"
#include "constraints/estimation/adjustment.h"
#include "constraints/estimation/judgement.h"
#include "constraints/measurement_context.h"
#include "diagnosis/options.h"
#include "diagnosis/validation/correction.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A model and its fit to the `fit` rows.
struct FittedCorrection {
  std::shared_ptr<const Robot> model;
  std::unique_ptr<Equations> equations;
  Adjusted adjusted;

  Judged judged(const DataSet& data) const {
    return judge(*model, data, *equations, adjusted.fitted);
  }
};

/// The full, nonlinear identification of `geometry` and of all parameters of the correction's
/// effects, which may be none. `near`: where the geometry's own fit of the same rows ended.
FittedCorrection fit_correction(const std::shared_ptr<const Robot>& geometry, const DataSet& data,
                                const Correction& correction, const MeasurementContext& context,
                                const DiagnosisOptions& options, const State* near = nullptr);

}  // namespace selfcal
