#include "diagnosis/warnings.h"

#include <cmath>

#include "diagnosis/diagnosis.h"

namespace selfcal {
namespace {

constexpr double kGearSigmas = 3;

std::string of_fits(const Adjusted& before, const Adjusted& after) {
  if (before.fitted.converged && after.fitted.converged) return {};
  return "a fit did not converge: " + (before.fitted.converged ? after : before).fitted.stop_reason;
}

std::string of_gears(const View& view) {
  std::string gears;
  const std::vector<Parameter>& parameters = view.geometry().parameters();
  const Fit& fitted = view.adjusted().fitted;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double off = fitted.state.xi[at] - parameters[i].nominal;
    if (parameters[i].part == Part::gear &&
        std::abs(off) > kGearSigmas * std::sqrt(fitted.covariance(at, at)))
      gears += (gears.empty() ? "" : ", ") + parameters[i].name + " " +
               format_number(std::round(1e6 * off)) + " ppm";
  }
  if (gears.empty()) return {};
  return "gear ratios are free here, so that none that is off is taken for a cause; off by more "
         "than three sigma: " +
         gears;
}

}  // namespace

std::string warning_of_gap(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (diagnosis.verdict.effect == "none") return {};
  if (gap.rows == 0)
    return "too few rows to keep some aside: nothing confirms it, and how far the gap closes is "
           "not "
           "known";
  if (diagnosis.verdict.effect != "unknown" && gap.rms_after >= gap.rms_before)
    return "the rows kept aside do not confirm it: they are met no better with the effects than "
           "without; do not use the corrected model";
  if (!gap.closed_fraction)
    return "the gap is hardly larger than the noise: the rows kept aside cannot tell how far it "
           "closes";
  if (diagnosis.verdict.effect != "unknown" && gap.closed_least <= 0)
    return "the rows kept aside are too few to confirm it: as far as they tell, nothing may have "
           "closed; measure more before the corrected model is used";
  return {};
}

std::vector<std::string> warnings_of(const View& view, const Adjusted& after) {
  std::vector<std::string> list;
  for (const std::string& each : {of_fits(view.adjusted(), after), of_gears(view)})
    if (!each.empty()) list.push_back(each);
  return list;
}

}  // namespace selfcal
