#include "diagnosis/report/warnings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/constants.h"
#include "diagnosis/findings.h"
#include "diagnosis/report/doubt.h"
#include "diagnosis/report/scatter.h"
#include "diagnosis/report/uneven_noise.h"
#include "diagnosis/search/causes.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/readable.h"
#include "kinematics/statics.h"

namespace selfcal {
namespace {

constexpr double kOnEarth = 9.81;  // m/s^2

std::string of_fits(const HoldoutValidation& validation) {
  if (validation.converged) return {};
  return "a fit did not converge: " + validation.stop_reason;
}

std::string of_undecided(const HoldoutValidation& validation) {
  if (validation.undecided == 0) return {};
  return std::to_string(validation.undecided) +
         (validation.undecided == 1 ? " row kept aside was" : " rows kept aside were") +
         " taken when the step may or may not have happened, and judge" +
         (validation.undecided == 1 ? "s" : "") + " nothing";
}

/// With everything found in the model, which may be what a gear alone would have stood for.
std::string of_gears(const HoldoutValidation& validation) {
  const Fit& fitted = validation.all.fitted;
  const auto parameters = static_cast<Eigen::Index>(validation.model->parameters().size());
  return warning_of_gears(*validation.model, fitted.state.xi,
                          fitted.covariance.diagonal().head(parameters).cwiseSqrt());
}

bool slides(const Robot& robot, const std::string& frame) {
  return std::ranges::any_of(robot.joints(), [&](const Joint& each) {
    return each.name == frame && each.quantity == Quantity::length;
  });
}

std::string stated_noise(const Set& set) {
  std::string text;
  if (set.noise > 0) text += with_figures("%.4g mm", 1e3 * set.noise);
  if (set.noise_angle > 0)
    text += (text.empty() ? "" : ", ") + with_figures("%.4g mrad", 1e3 * set.noise_angle);
  return text;
}

std::string of_noise(const LinearisedModel& linearised, const DataSet& data, const Gap& gap) {
  std::string sets;
  for (const int s : linearised.quieter())
    sets +=
        (sets.empty() ? "" : ", ") + data.sets[s].name + " (" + stated_noise(data.sets[s]) + ")";
  if (sets.empty()) return {};
  return "the noise is taken from the data sheet, of " + sets +
         ": calibration leaves less there, and no row is repeated that would tell what it really "
         "is" +
         (may_state_millimetres(gap) ? "; is it in metres, and 1 sigma?" : "");
}

std::string of_masses(const LinearisedModel& linearised) {
  const Statics* statics = linearised.geometry().statics();
  if (!statics || !statics->mechanics().masses_assumed) return {};
  double mass = 0;
  for (const Link& link : statics->mechanics().links) mass += link.mass.value_or(0);
  const std::string moving = format_number(std::round(mass)) + " kg moving",
                    of_size = format_number(kDiagnosis.shapes.mass_off),
                    of_spread = format_number(kDiagnosis.shapes.spread_off);
  if (!linearised.mass_of_its_size())
    return "the masses of the links are usual ones, spread of the file's `mass:` and `payload:` (" +
           moving + "): compliances may be " + of_spread + " times off with them, beyond their " +
           "sigma; those of each link are better";
  return "the file gives no masses of the links: usual ones are taken, " + moving +
         ": compliances may be " + of_size + " times off with them, beyond their sigma; `mass:` " +
         "and `payload:` of the data sheet, or those of the links, are better";
}

std::string of_order(const DataSet& data) {
  if (!data.order_is_time) return {};
  return "the rows carry no time: their order is taken for it, a second from one to the next; a "
         "drift is half as sure for that, since whatever goes with their places in this order "
         "looks "
         "like one";
}

std::string of_strange_masses(const Robot& robot) {
  const std::string strange =
      robot.statics() ? strange_masses(robot.statics()->mechanics()) : std::string();
  return strange.empty() ? strange : strange + " What gives way under weights is told with them";
}

}  // namespace

std::string warning_of_gears(const Robot& robot, const Eigen::VectorXd& xi,
                             const Eigen::VectorXd& sigma) {
  const double sigmas = kDiagnosis.report.gear_sigmas;
  std::string gears;
  std::vector<Eigen::Index> sliding;
  bool alike = true;
  for (Eigen::Index i = 0; i < sigma.size(); ++i) {
    const Parameter& gear = robot.parameters()[static_cast<std::size_t>(i)];
    if (gear.part != Part::gear) continue;
    const double off = xi[i] - gear.nominal;
    const bool is_off = std::abs(off) > sigmas * sigma[i];
    if (is_off)
      gears += (gears.empty() ? "" : ", ") + gear.name + " " +
               format_number(std::round(1e6 * off)) + " ppm";
    if (!slides(robot, gear.frame)) continue;
    for (const Eigen::Index other : sliding)
      alike = alike && std::abs(off - (xi[other] - robot.parameters()[other].nominal)) <
                           sigmas * std::hypot(sigma[i], sigma[other]);
    alike = alike && is_off;
    sliding.push_back(i);
  }
  if (gears.empty()) return {};
  return std::string(kGearsOff) + gears +
         (alike && sliding.size() > 1 ? "; those of all sliding joints by as much: an instrument "
                                        "whose scale is off looks the same"
                                      : "");
}

std::string gears_beside_none(const Diagnosis& diagnosis) {
  const auto off = std::ranges::find_if(
      diagnosis.warnings, [](const std::string& each) { return each.starts_with(kGearsOff); });
  if (diagnosis.verdict.effect != kNone || off == diagnosis.warnings.end()) return {};
  return "; that is with the gears' ratios free (identify frees one with --free and its name), of "
         "which some are off: " +
         off->substr(kGearsOff.size());
}

std::string warning_of_few_waves(const Robot& robot, const Eigen::MatrixXd& q,
                                 const std::vector<CauseResult>& named) {
  std::string places;
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    const Joint& joint = robot.joints()[j];
    const auto column = q.col(static_cast<Eigen::Index>(j));
    const double way = column.maxCoeff() - column.minCoeff();
    const double turns = joint.quantity == Quantity::length ? way : way / (2 * std::numbers::pi);
    double waves = 0;
    for (const CauseResult& each : named)
      for (const FoundEffect& found : each.correction)
        if (found.what.effect == "transmission_error" && found.what.at == joint.name)
          for (const double k : found.what.shape.waves) waves = std::max(waves, k * turns);
    if (waves > 0 && waves < kDiagnosis.report.fewest_waves)
      places += (places.empty() ? "" : ", ") + joint.name;
  }
  if (places.empty()) return {};
  return "transmission_error at " + places +
         ": hardly a wave lies in what the rows move it by: a pitch that grows along it, a rail "
         "that bows, a cable that pulls, look like it";
}

std::string warning_of_own_effects(const Robot& robot) {
  std::string names;
  for (const Effect* effect : effects_of(robot))
    names += (names.empty() ? "" : ", ") + label(std::string(effect->name()), effect->at());
  if (names.empty()) return {};
  return "the effects in the robot's file are not used (" + names +
         "): the diagnosis begins at the geometry alone and finds anew what is there";
}

std::string warning_of_gap(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (diagnosis.verdict.effect == kNone) return {};
  if (gap.rows == 0)
    return diagnosis.gap_unjudged +
           ": nothing confirms it, and how far the gap closes is not known";
  const bool named = diagnosis.verdict.effect != kUnknown || !diagnosis.named.empty();
  if (named && gap.rms_after >= gap.rms_before)
    return std::string(
               "the rows kept aside do not confirm it: they are met no better with it "
               "than without") +
           (gap.rms_all * kDiagnosis.report.rest_worse < gap.rms_before
                ? ", though better with everything found"
                : "; do not use the corrected model");
  if (!gap.closed.fraction)
    return "the gap is hardly larger than the noise: the rows kept aside cannot tell how far it "
           "closes";
  if (named && gap.closed.least <= 0)
    return std::string(
               "the rows kept aside are too few to confirm it: as far as they tell, it may "
               "have closed nothing") +
           (gap.closed_all.least > 0 ? ", though everything found closes some of the gap"
                                     : "; measure more before the corrected model is used");
  return {};
}

std::string warning_of_gravity(const Robot& robot) {
  if (!robot.statics()) return {};
  const double g = gravity_of(robot).norm();
  if (std::abs(g - kOnEarth) < kDiagnosis.report.gravity_off) return {};
  return with_figures("gravity is %.3g m/s^2 in the robot's file, 9.81 on earth: ", g) +
         (g > 0 ? "what gives way under weights is told with it"
                : "nothing has a weight, and nothing can give way under one");
}

std::vector<std::string> warnings_of(const LinearisedModel& linearised, const DataSet& data,
                                     const HoldoutValidation& validation,
                                     const Diagnosis& diagnosis) {
  std::vector<std::string> list;
  for (const std::string& each :
       {of_fits(validation), of_undecided(validation), of_gears(validation),
        warning_of_few_waves(linearised.geometry(), data.rows.q, diagnosis.named),
        of_noise(linearised, data, diagnosis.gap), warning_of_scatter(linearised, data, diagnosis),
        warning_of_uneven_noise(linearised, data, diagnosis), of_order(data), of_masses(linearised),
        warning_of_gravity(linearised.geometry()), of_strange_masses(linearised.geometry())})
    if (!each.empty()) list.push_back(each);
  return list;
}

}  // namespace selfcal
