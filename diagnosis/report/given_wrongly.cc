#include "diagnosis/report/given_wrongly.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "constraints/estimation/identification.h"
#include "diagnosis/constants.h"
#include "diagnosis/report/named.h"
#include "diagnosis/report/recalibration.h"
#include "kinematics/effect.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// The gear whose ratio is off by the most sigmas, no farther than any file's is; none where that
/// is no more than a few.
const ParameterResult* farthest_off(const Solution& calibrated) {
  const ParameterResult* farthest = nullptr;
  double most = kDiagnosis.report.gear_sigmas;
  for (const ParameterResult& each : calibrated.parameters) {
    if (each.parameter.part != Part::gear || !(each.sigma > 0)) continue;
    const double off = std::abs(each.value - each.parameter.nominal), sigmas = off / each.sigma;
    if (sigmas <= most || off > kDiagnosis.report.gear_sigmas * kDiagnosis.report.wrong_ratio *
                                    std::abs(each.parameter.nominal))
      continue;
    most = sigmas;
    farthest = &each;
  }
  return farthest;
}

}  // namespace

std::string length_given_wrongly(const Diagnosis& diagnosis, const Solution& calibrated) {
  const RobotScale& scale = calibrated.scale;
  const auto too_large = [](const CauseResult& each) {
    if (each.effect == "scale_error" || each.effect == "thermal_expansion") return false;
    const bool at_will = lasting_of(each.effect) == EffectLasting::moved_at_will;
    return beyond_usual(each, at_will ? kDiagnosis.report.impossible
                                      : kDiagnosis.report.far_beyond) != nullptr;
  };
  if (scale.contradictions.empty() || std::ranges::none_of(diagnosis.named, too_large)) return {};
  return scale.contradictions.front();
}

std::string ratio_given_wrongly(const LinearisedModel& linearised, const DataSet& data,
                                const Diagnosis& diagnosis) {
  const auto is_far_beyond = [](const CauseResult& each) {
    return beyond_usual(each, kDiagnosis.report.far_beyond) != nullptr;
  };
  if (std::ranges::none_of(diagnosis.named, is_far_beyond)) return {};
  Correction usual;
  std::ranges::remove_copy_if(
      diagnosis.found, std::back_inserter(usual), [&](const FoundEffect& found) {
        return std::ranges::any_of(diagnosis.named, [&](const CauseResult& each) {
          return is_far_beyond(each) && is_of(each, found);
        });
      });
  const std::shared_ptr<const Robot> robot = with_effects(linearised, usual);
  Options options = free_effects(*robot);
  options.gears = true;
  options.gear_sigma = kDiagnosis.report.wrong_ratio;
  const Solution with_any = identify(*robot, data, options);
  const ParameterResult* suspect = farthest_off(with_any);
  if (suspect == nullptr) return {};
  options.gears = false;
  options.free.push_back(suspect->parameter.name);
  const Solution calibrated = identify(*robot, data, options);
  const ParameterResult* gear = farthest_off(calibrated);
  const Figures& fit = calibrated.residual.fit;
  const double left = fit.rms_after, with_all = left_with(linearised, data, diagnosis.found);
  const char* unit = fit.angle_alone ? "rad" : "m";
  if (gear == nullptr ||
      kDiagnosis.report.better_than_moved * std::pow(left, 2) > std::pow(with_all, 2))
    return {};
  return "with the gear ratio of " + gear->parameter.frame + " " +
         with_figures("%.2g", 100 * (gear->value / gear->parameter.nominal - 1)) +
         " % off what the robot's file says (" + gear->parameter.name + " = " +
         with_figures("%.5g", gear->value) + "), calibration leaves " +
         in_readable_unit(left, unit) + ", as little as with what would be named (" +
         in_readable_unit(with_all, unit) + ")";
}

}  // namespace selfcal
