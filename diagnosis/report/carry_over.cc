#include "diagnosis/report/carry_over.h"

#include <algorithm>
#include <utility>

#include "constraints/measurement_context.h"
#include "diagnosis/constants.h"
#include "diagnosis/report/fitted_correction.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

std::string figure(double metres) { return plain_figure(1e3 * metres) + " mm"; }

}  // namespace

std::string leave_out_what_does_not_carry_over(const DataSet& data, const DiagnosisOptions& options,
                                               Diagnosis& diagnosis) {
  const Gap before = diagnosis.gap;
  const auto rest = std::ranges::count(diagnosis.found, false, &FoundEffect::named);
  if (rest == 0 || before.rows == 0 ||
      before.rms_all <= kDiagnosis.report.rest_worse * before.rms_after)
    return {};
  diagnosis.found = named_of(diagnosis.found);
  const std::shared_ptr<const Robot> geometry = geometry_of(diagnosis.model);
  FittedCorrection kept =
      fit_correction(geometry, data, diagnosis.found, context_of(*geometry, data), options);
  diagnosis.model = std::move(kept.model);
  diagnosis.values = kept.adjusted.fitted.state.xi;
  diagnosis.converged = diagnosis.converged && kept.adjusted.fitted.converged;
  for (ValidationRow& row : diagnosis.validation_rows) row.all = row.after;
  diagnosis.gap =
      gap_of(diagnosis.validation_rows, options.seed, diagnosis.floor_freedom, before.validated_on);
  return "everything found leaves " + figure(before.rms_all) + " of the rows kept aside, and " +
         figure(before.rms_after) +
         (rest > 1 ? " without the " + std::to_string(rest) + " effects that are"
                   : " without the effect that is") +
         " not named: these do not carry over and are left out of the corrected model";
}

}  // namespace selfcal
