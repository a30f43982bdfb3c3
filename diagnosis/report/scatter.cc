#include "diagnosis/report/scatter.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/tails.h"
#include "diagnosis/search/naming.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// Density of a Student variable of five freedoms and this scale.
double student_of_five(double value, double scale) {
  const double t = value / scale;
  return 8 / (3 * M_PI * std::sqrt(5.0)) * std::pow(1 + t * t / 5, -3) / scale;
}

bool is_worth_a_word(const Scatter& scatter) {
  return scatter.found > kDiagnosis.report.worth_a_word * scatter.declared;
}

}  // namespace

std::vector<Scatter> scatter_of_sets(const LinearisedModel& linearised, const DataSet& data) {
  const std::vector<Scale> noise = linearised.noise_of_sets();
  const std::vector<RowResidual> residuals = linearised.residuals_of_rows();
  std::vector<Scatter> list;
  const auto add = [&](int set, bool lengths, double declared, double found,
                       const RepeatSpread& repeats) {
    if (declared <= 0) return;
    auto alike = std::ranges::find_if(list, [&](const Scatter& each) {
      return each.lengths == lengths && each.declared == declared && each.found == found;
    });
    if (alike == list.end())
      alike = list.insert(alike,
                          {.sets = {}, .lengths = lengths, .declared = declared, .found = found});
    alike->sets.push_back(set);
    alike->repeats.squares += repeats.squares;
    alike->repeats.freedom += repeats.freedom;
  };
  for (std::size_t s = 0; s < data.sets.size(); ++s) {
    const Set& set = data.sets[s];
    if (set.noise_joints > 0) continue;
    const int at = static_cast<int>(s);
    const RepeatSpreads repeats = repeat_spreads(data, at, residuals, linearised.outlier());
    if (set.method->has_lengths()) add(at, true, set.noise, noise[s].length, repeats.length);
    if (set.method->has_angles()) add(at, false, set.noise_angle, noise[s].angle, repeats.angle);
  }
  return list;
}

std::string scatter_in_words(const Scatter& scatter, const DataSet& data) {
  const auto figure = [&](double value) {
    return scatter.lengths ? plain_figure(1e3 * value) + " mm" : in_readable_unit(value, "rad");
  };
  std::vector<std::string> names;
  for (const int s : scatter.sets) names.push_back(data.sets[static_cast<std::size_t>(s)].name);
  const bool beside =
      !scatter.lengths &&
      data.sets[static_cast<std::size_t>(scatter.sets.front())].method->has_lengths();
  return (beside ? "the angles of " : "the rows of ") + listed(names) + " scatter by " +
         figure(scatter.found) +
         " around the model that explains them best, and their files state a noise of " +
         figure(scatter.declared) +
         (scatter.repeats.freedom > 0
              ? ", and their repeats differ by " + figure(scatter.repeats.sigma())
              : "");
}

double log_confirmed(const Scatter& scatter) {
  const double found = scatter.found * scatter.found,
               declared = scatter.declared * scatter.declared;
  return scatter.repeats.squares / 2 * (1 / declared - 1 / found) -
         scatter.repeats.freedom / 2 * std::log(found / declared);
}

double unknown_by_scatter(const Scatter& scatter, double freedom) {
  const double ratio = scatter.found / scatter.declared;
  const ReportConstants& rules = kDiagnosis.report;
  const double size = std::sqrt(std::max(0.0, ratio * ratio - 1));  // of it, over the noise
  if (size < rules.least_scattered) return 0;
  const double of_unknown =
      ratio * ratio / (size * size) / std::log(rules.most_scattered / rules.least_scattered);
  const double off = std::hypot(rules.sheet_is_off, 1 / std::sqrt(2 * freedom));
  const double log_odds =
      std::log(rules.scattered * of_unknown / student_of_five(std::log(ratio), off)) -
      log_confirmed(scatter);
  return 1 / (1 + std::exp(-log_odds));
}

void doubt_noise(const LinearisedModel& linearised, const DataSet& data, double freedom,
                 Diagnosis& diagnosis) {
  if (diagnosis.verdict.effect != kNone) return;
  double probability = kDiagnosis.naming.probable;
  for (const Scatter& each : scatter_of_sets(linearised, data)) {
    const double unknown = unknown_by_scatter(each, freedom);
    if (diagnosis.scatter.empty() && is_worth_a_word(each) &&
        log_confirmed(each) > kDiagnosis.report.surely_confirmed)
      diagnosis.scatter = scatter_in_words(each, data);
    if (unknown <= probability) continue;
    probability = unknown;
    const double squares = freedom * std::pow(each.found / each.declared, 2);
    diagnosis.p_value =
        std::max(kDiagnosis.naming.least_p, -std::expm1(NoiseTail(freedom).log_below(squares)));
    diagnosis.scatter = scatter_in_words(each, data);
    diagnosis.verdict = {.effect = kUnknown, .probability = probability};
  }
  if (diagnosis.verdict.effect != kUnknown) return;
  for (CauseResult& each : diagnosis.candidates) {
    if (each.effect == kUnknown) each.probability = std::max(each.probability, probability);
    if (each.effect == kNone) each.probability = std::min(each.probability, 1 - probability);
  }
  agree(diagnosis.candidates, diagnosis.verdict);
}

std::string warning_of_scatter(const LinearisedModel& linearised, const DataSet& data,
                               const Diagnosis& diagnosis) {
  if (!diagnosis.scatter.empty()) return {};
  std::string words;
  for (const Scatter& each : scatter_of_sets(linearised, data))
    if (is_worth_a_word(each)) words += (words.empty() ? "" : "; ") + scatter_in_words(each, data);
  return words;
}

}  // namespace selfcal
