#include "app/service/session/acceptance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "constraints/estimation/check_comparison.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kFewestFreedoms = 8;  // to compare squares by
constexpr double kLeastFitP = 1e-3;    // below it what is left is more than noise
constexpr double kLeastExcess = 1.3;   // of squares over those of noise that are worth a search

template <class... Values>
std::string sentence(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

struct ParameterChange {
  const ParameterResult* parameter = nullptr;
  double change = 0;
};

/// The parameter that changes most against its limit, and the one that changes most against its
/// sigma.
std::pair<ParameterChange, ParameterChange> largest_changes(const ByPart& limits,
                                                            const Robot& active,
                                                            const Solution& candidate) {
  ParameterChange against_limit, against_sigma;
  double most = 0, most_sigmas = 0;
  // The geometry's come first, whatever effects either has.
  const std::size_t count = std::min(candidate.parameters.size(), active.parameters().size());
  for (std::size_t i = 0; i < count; ++i) {
    const ParameterResult& each = candidate.parameters[i];
    if (each.parameter.part == Part::effect) break;
    const double change = each.value - active.parameters()[i].value;
    const double share = std::abs(change) / limits.of(each.parameter);
    if (share > most) {
      most = share;
      against_limit = {&each, change};
    }
    if (each.sigma > 0 && each.status == Status::identified &&
        std::abs(change) / each.sigma > most_sigmas) {
      most_sigmas = std::abs(change) / each.sigma;
      against_sigma = {&each, change};
    }
  }
  return {against_limit, against_sigma};
}

}  // namespace

AcceptanceDecision decide_on_result(const Acceptance& accept, const Robot& active,
                                    const Solution& candidate, const Solution& unchanged) {
  AcceptanceDecision decided;
  decided.answer = candidate.verdict.answer;
  decided.endpoint_sigma = candidate.workspace.rms;
  decided.outliers = count_outliers(candidate);
  decided.identified = parameters_identified(candidate);
  const CheckComparison compared =
      compare_check_rows(unchanged.residual.check_rows, candidate.residual.check_rows);
  decided.check_before = compared.rms_before;
  decided.check_after = compared.rms_after;
  decided.p_value = compared.p_value;
  if (candidate.verdict.answer != Answer::improved) {
    decided.why = candidate.verdict.why;
    return decided;
  }
  const char* const unit_of_rows = candidate.residual.check.angle_alone ? "mrad" : "mm";
  if (!(decided.check_after < (1 - accept.margin) * decided.check_before)) {
    decided.why =
        sentence("the active parameters explain the check rows as well: %.4g %s against %.4g",
                 1e3 * decided.check_before, unit_of_rows, 1e3 * decided.check_after);
    return decided;
  }
  if (!compared.better()) {
    decided.why = sentence(
        "the check rows do not say that the active parameters are worse: %.4g %s against %.4g "
        "(p = %.2g)%s",
        1e3 * decided.check_before, unit_of_rows, 1e3 * decided.check_after, decided.p_value,
        !compared.lengths_fall ? ", some of them are met much worse"
        : compared.angles_rise ? ", the angles are met worse"
                               : "");
    return decided;
  }
  const auto [limit, sigma] = largest_changes(accept.largest_change, active, candidate);
  if (limit.parameter) {
    const double most = accept.largest_change.of(limit.parameter->parameter);
    if (std::abs(limit.change) > most) {
      decided.why =
          sentence("%s changes by %.4g m%s, more than the limit of %.4g: look at the robot first",
                   limit.parameter->parameter.name.c_str(), 1e3 * limit.change,
                   std::string(unit(limit.parameter->parameter.quantity)).c_str(), 1e3 * most);
      return decided;
    }
  }
  decided.acceptable = true;
  decided.why = sentence("check residual %.4g to %.4g %s", 1e3 * decided.check_before,
                         1e3 * decided.check_after, unit_of_rows);
  if (sigma.parameter)
    decided.why += sentence("; surest change: %s by %.3g m%s (%.0f sigma)",
                            sigma.parameter->parameter.name.c_str(), 1e3 * sigma.change,
                            std::string(unit(sigma.parameter->parameter.quantity)).c_str(),
                            std::abs(sigma.change) / sigma.parameter->sigma);
  for (const std::string& set : candidate.locks_left_out) {
    decided.asks = true;
    decided.why += "; not applied by itself: the lock of set " + set + " slipped again and again";
  }
  return decided;
}

FitDecision decide_on_fit(const Solution& solution, const std::vector<Set>& sets) {
  FitDecision decided;
  const LackOfFit& fit = solution.uncertainty.lack_of_fit;
  double ratio = 0;
  const char* against = "repeats";
  if (fit.p_value >= 0 && fit.repeat_freedoms >= kFewestFreedoms) {
    ratio = fit.F;
    decided.p_value = fit.p_value;
  } else {
    against = "data sheets";
    double rows = 0;
    for (const SetResult& each : solution.sets) {
      const auto set = std::ranges::find(sets, each.name, &Set::name);
      if (set == sets.end() || set->noise <= 0 || each.noise_sigma <= 0 || each.used == 0) continue;
      rows += each.used;
      ratio += each.used * std::pow(each.noise_sigma / set->noise, 2);
    }
    const LackOfFit& of_rows = solution.uncertainty.lack_of_fit;
    const double freedoms = of_rows.freedoms + of_rows.repeat_freedoms;
    if (rows == 0 || freedoms < kFewestFreedoms) {
      decided.why = "nothing says how large the noise is";
      return decided;
    }
    ratio /= rows;
    decided.p_value = chi_square_exceeds(ratio * freedoms, freedoms);
  }
  decided.noise = decided.p_value >= kLeastFitP || ratio < kLeastExcess;
  decided.why = sentence("what is left is %.3g times the noise that the %s tell (p = %.2g): %s",
                         std::sqrt(ratio), against, decided.p_value,
                         decided.noise ? "noise" : "something unmodelled is at work");
  return decided;
}

std::uint32_t parameters_identified(const Solution& solution) {
  return static_cast<std::uint32_t>(
      std::ranges::count(solution.parameters, Status::identified, &ParameterResult::status));
}

std::uint32_t count_outliers(const Solution& solution) {
  return static_cast<std::uint32_t>(std::ranges::count(solution.outliers, false, &Outlier::check));
}

CheckDecision decide_on_check(const Solution& then, const Solution& now, double least_p) {
  CheckDecision decided;
  const Figures& before = then.residual.check;
  const Figures& after = now.residual.check;
  decided.check_after = after.rms_after;
  decided.check_before = before.rms_without_outliers;
  if (before.rows == 0 || after.rows == 0 || !(decided.check_before > 0) ||
      !std::isfinite(decided.check_after)) {
    decided.why = "nothing to compare with";
    return decided;
  }
  decided.p_value = f_exceeds(std::pow(decided.check_after / decided.check_before, 2),
                              after.configurations, before.configurations);
  decided.explained = decided.p_value >= least_p;
  decided.why =
      sentence("%d touches with %.4g mm rms against %.4g expected (p = %.2g): %s", after.rows,
               1e3 * decided.check_after, 1e3 * decided.check_before, decided.p_value,
               decided.explained ? "the active model explains them"
                                 : "the active model does not explain them");
  return decided;
}

}  // namespace selfcal
