#include "diagnosis/search/shapes.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/visits.h"
#include "diagnosis/findings.h"

namespace selfcal {
namespace {

bool is_asked(const Candidate& candidate, const std::string& asked) {
  const size_t at = asked.find('@');
  return candidate.effect == asked.substr(0, at) &&
         (at == std::string::npos || candidate.at == asked.substr(at + 1));
}

std::string known_names() {
  std::string known;
  for (const std::string_view name : effect_names())
    known += (known.empty() ? "" : ", ") + std::string(name);
  return known;
}

/// Why none of the candidates is `asked`.
std::string why_none(const LinearisedModel& linearised, const std::string& asked) {
  const std::string effect = asked.substr(0, asked.find('@'));
  const std::vector<std::string_view> names = effect_names();
  if (std::find(names.begin(), names.end(), effect) == names.end())
    return "no effect is called '" + effect + "'; known: " + known_names();
  for (const Untestable& each : linearised.candidates().untestable)
    if (each.effect == effect) return asked + ": " + each.why;
  return asked + ": it cannot act there on these rows";
}

/// Of every effect asked for, by place, the shape with the best evidence.
ChosenEffects best_shapes(const LinearisedModel& linearised, const DataSet& data,
                          const std::vector<std::string>& asked, const DiagnosisOptions& options) {
  ChosenEffects chosen;
  const DenseEquations rows = linearised.kept();
  const Candidates all = with_profiles(linearised.candidates());
  const EvidenceEvaluator evaluator(
      linearised.whitened(),
      noise_alone(data.rows, rows, linearised.reading_errors(),
                  noise_of_visits(data.rows, rows, linearised.left())),
      all, linearised.parameters(), options.search);
  for (const std::string& each : asked) {
    std::map<std::string, std::pair<double, int>> best;  // by place
    for (int c = 0; c < static_cast<int>(all.list.size()); ++c) {
      const Candidate& candidate = all.list[c];
      if (!is_asked(candidate, each) || !candidate.slack.empty()) continue;
      const double evidence = evaluator.evidence(c);
      const auto [slot, made] =
          best.try_emplace(candidate.at, -std::numeric_limits<double>::infinity(), -1);
      if (slot->second.second < 0 || evidence > slot->second.first) slot->second = {evidence, c};
    }
    if (best.empty()) chosen.problem = why_none(linearised, each);
    for (const auto& [place, found] : best) {
      const Candidate& candidate = all.list[found.second];
      chosen.effects.push_back({candidate.effect, candidate.at, candidate.shape});
    }
  }
  return chosen;
}

}  // namespace

ChosenEffects choose_effects(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                             const std::vector<std::string>& asked) {
  const DiagnosisOptions options;
  LinearisedModel linearised(robot, data, options, {});
  ChosenEffects chosen = best_shapes(linearised, data, asked, options);
  std::vector<ShapedEffect> steps;
  std::ranges::copy_if(chosen.effects, std::back_inserter(steps),
                       [](const ShapedEffect& each) { return each.shape.moment.has_value(); });
  if (!steps.empty() && linearised.try_moments_near(steps))
    chosen = best_shapes(linearised, data, asked, options);
  return chosen;
}

}  // namespace selfcal
