#include "diagnosis/report/given_wrongly.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>

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

/// What a transmission error with these parameters (JOINT.sinK, JOINT.cosK) adds to the joint's
/// reading.
double added_at(const std::vector<NamedValue>& parameters, const std::string& joint, double angle) {
  double sum = 0;
  for (const NamedValue& each : parameters) {
    if (!each.name.starts_with(joint + ".")) continue;
    const std::size_t wave = each.name.rfind("sin"), other = each.name.rfind("cos");
    if (wave == std::string::npos && other == std::string::npos) continue;
    const bool sine = wave != std::string::npos;
    const double waves = std::strtod(each.name.c_str() + (sine ? wave : other) + 3, nullptr);
    sum += each.value * (sine ? std::sin(waves * angle) : std::cos(waves * angle));
  }
  return sum;
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

std::string reading_scaled_wrongly(const Robot& robot, const Eigen::MatrixXd& q,
                                   const std::vector<CauseResult>& named) {
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    const Joint& joint = robot.joints()[j];
    const auto of_joint = std::ranges::find_if(named, [&](const CauseResult& each) {
      return each.effect == "transmission_error" && std::ranges::count(each.where, joint.name) > 0;
    });
    if (of_joint == named.end() || q.rows() == 0 ||
        std::ranges::any_of(robot.parameters(), [&](const Parameter& p) {
          return p.part == Part::gear && p.frame == joint.name;
        }))
      continue;
    const double scale = joint.quantity == Quantity::angle ? 1 : 2 * std::numbers::pi;
    const Eigen::ArrayXd reading = q.col(static_cast<Eigen::Index>(j)).array();
    const Eigen::ArrayXd error = (scale * reading).unaryExpr([&](double at) {
      return added_at(of_joint->parameters, joint.name, at);
    });
    const Eigen::ArrayXd x = reading - reading.mean(), e = error - error.mean();
    const double along = (x * e).sum(), squares = x.square().sum() * e.square().sum();
    if (!(squares > 0) || along * along < kDiagnosis.report.straight * squares) continue;
    return "what would be named at " + joint.name + " grows with its reading, by " +
           with_figures("%.2g", 100 * along / x.square().sum()) +
           " %: is the unit that it is read in (lead, pulses, gear) right?";
  }
  return {};
}

}  // namespace selfcal
