#include "diagnosis/report/fitted_correction.h"

#include "diagnosis/evidence/linearised_model.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"

namespace selfcal {

FittedCorrection fit_correction(const std::shared_ptr<const Robot>& geometry, const DataSet& data,
                                const Correction& correction, const MeasurementContext& context,
                                const DiagnosisOptions& options, const State* near) {
  FittedCorrection fit;
  Problems problems;
  Options free = geometry_options(options);
  for (const FoundEffect& each : correction)
    free.effect_sigma.insert(free.effect_sigma.end(), each.sigma.begin(), each.sigma.end());
  fit.model = correct(geometry, entries_of(correction), context, problems);
  expects(fit.model != nullptr,
          "what was found is effects that the robot can have" +
              (problems.any() ? ": " + problems.list.front() : std::string()));
  fit.equations = std::make_unique<Equations>(*fit.model, data, Use::fit);
  for (const Parameter& p : fit.model->parameters())
    if (p.part == Part::effect) free.free.push_back(p.name);
  fit.adjusted = adjust(*fit.equations, free, {}, near);
  return fit;
}

}  // namespace selfcal
