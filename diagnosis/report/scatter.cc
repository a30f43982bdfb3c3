#include "diagnosis/report/scatter.h"

#include <algorithm>
#include <cmath>

#include "constraints/fitting/noise.h"
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

bool is_confirmed(const SetScatter& scatter) {
  return scatter.repeats > kDiagnosis.report.surely_confirmed * scatter.found;
}

}  // namespace

std::vector<SetScatter> scatter_of_sets(const LinearisedModel& linearised, const DataSet& data) {
  const std::vector<Scale> noise = linearised.noise_of_sets();
  std::vector<SetScatter> list;
  for (std::size_t s = 0; s < data.sets.size(); ++s) {
    const Set& set = data.sets[s];
    const bool lengths = set.method->has_lengths();
    SetScatter each{.set = static_cast<int>(s),
                    .lengths = lengths,
                    .declared = lengths ? set.noise : set.noise_angle,
                    .found = lengths ? noise[s].length : noise[s].angle};
    if (each.declared <= 0 || set.noise_joints > 0) continue;
    each.repeats = std::max(
        0.0, repeat_sigma(data, each.set, linearised.residuals_of_rows(), linearised.outlier()));
    list.push_back(each);
  }
  return list;
}

std::string scatter_in_words(const SetScatter& scatter, const DataSet& data) {
  const auto figure = [&](double value) {
    return scatter.lengths ? plain_figure(1e3 * value) + " mm" : in_readable_unit(value, "rad");
  };
  return "the rows of " + data.sets[static_cast<std::size_t>(scatter.set)].name + " scatter by " +
         figure(scatter.found) +
         " around the model that explains them best, and their files state a noise of " +
         figure(scatter.declared) +
         (scatter.repeats > 0 ? ", and their repeats differ by " + figure(scatter.repeats) : "");
}

double unknown_by_scatter(const SetScatter& scatter, double freedom) {
  const double ratio = scatter.found / scatter.declared;
  const auto& sizes = kDiagnosis.evidence.sizes;
  const double size =
      std::sqrt(std::max(0.0, ratio * ratio - 1));  // of the unknown, over the noise
  if (size < sizes.front() || is_confirmed(scatter)) return 0;
  const double of_unknown = ratio * ratio / (size * size) / std::log(sizes.back() / sizes.front());
  const double off = std::hypot(kDiagnosis.report.sheet_is_off, 1 / std::sqrt(2 * freedom));
  const double odds =
      kDiagnosis.report.scattered * of_unknown / student_of_five(std::log(ratio), off);
  return odds / (1 + odds);
}

void doubt_noise(const LinearisedModel& linearised, const DataSet& data, double freedom,
                 Diagnosis& diagnosis) {
  if (diagnosis.verdict.effect != kNone) return;
  if (std::ranges::any_of(diagnosis.candidates, [](const CauseResult& each) {
        return names_effect(each.effect) && each.probability > kDiagnosis.naming.worth_telling;
      }))
    return;
  for (const SetScatter& each : scatter_of_sets(linearised, data)) {
    const double probability = unknown_by_scatter(each, freedom);
    if (probability <= kDiagnosis.naming.probable) continue;
    if (!diagnosis.scatter.empty() && probability <= diagnosis.verdict.probability) continue;
    const double squares = freedom * std::pow(each.found / each.declared, 2);
    diagnosis.p_value =
        std::max(kDiagnosis.naming.least_p, -std::expm1(NoiseTail(freedom).log_below(squares)));
    diagnosis.scatter = scatter_in_words(each, data);
    say_unknown(probability, diagnosis.candidates, diagnosis.verdict);
  }
}

std::string warning_of_scatter(const LinearisedModel& linearised, const DataSet& data,
                               const Diagnosis& diagnosis) {
  if (!diagnosis.scatter.empty()) return {};
  std::string words;
  for (const SetScatter& each : scatter_of_sets(linearised, data))
    if (each.found > kDiagnosis.report.worth_a_word * each.declared)
      words += (words.empty() ? "" : "; ") + scatter_in_words(each, data);
  return words;
}

}  // namespace selfcal
