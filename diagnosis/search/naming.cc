#include "diagnosis/search/naming.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>

#include "diagnosis/constants.h"
#include "diagnosis/search/causes.h"
#include "diagnosis/search/sign_flip_test.h"

namespace selfcal {
namespace {

/// Probability that one of the candidates is there that `answers` says yes to.
double probability_of_any(const LinearisedModel& linearised, const Posterior& posterior,
                          const std::function<bool(const Candidate&)>& answers) {
  double sum = 0;
  for (const Hypothesis& h : posterior.hypotheses)
    if (std::ranges::any_of(h.candidates,
                            [&](int c) { return answers(linearised.candidates().list[c]); }))
      sum += std::exp(h.log_weight);
  return std::min(sum, 1.0);
}

/// Probability of the cause or of known ones that look the same on these rows.
double with_look_alikes_of(const LinearisedModel& linearised, const Posterior& posterior,
                           const CauseResult& cause) {
  return probability_of_any(linearised, posterior, [&](const Candidate& candidate) {
    return candidate.effect == cause.effect ||
           std::ranges::count(cause.confounded_with, label(candidate.effect, candidate.at)) > 0;
  });
}

/// `one` is among those that `other` cannot be told from.
bool is_look_alike(const CauseResult& one, const CauseResult& other) {
  return std::ranges::any_of(one.where, [&](const std::string& at) {
    return std::ranges::count(other.confounded_with, label(one.effect, at)) > 0;
  });
}

/// What the most probable causes and all that makes them more probable explain of the squares, and
/// what is left beyond the noise; both as the geometry alone sees them.
struct Shares {
  double explained = 0, left = 0;
};
Shares shares(const EvidenceEvaluator& evaluator, const Posterior& posterior) {
  const Hypothesis* best = &posterior.hypotheses.front();
  for (const Hypothesis& h : posterior.hypotheses)
    if (evaluator.structure(h.structure).kind > 0) {
      best = &h;
      break;
    }
  const MarginalLikelihood& plain = evaluator.marginal_likelihood(0);
  Hypothesis whole = *best;
  whole.structure = 0;
  whole = evaluator.grow(std::move(whole), kDiagnosis.naming.most_explaining);
  const double after = plain.given(evaluator.terms(whole)).total() * evaluator.noise_variance(0);
  const double before = plain.total() * evaluator.noise_variance(0);
  const double noise =
      evaluator.marginal_likelihood(best->structure).estimate(evaluator.terms(*best)).variance *
      evaluator.noise_variance(best->structure) * plain.freedom();
  return {before - after, after - noise};
}

/// At some place.
bool steps_again(const CauseResult& cause) {
  return std::ranges::any_of(cause.correction, [&](const FoundEffect& found) {
    return steps_at(cause, found.what.at) > 1;
  });
}

}  // namespace

CauseResult without_cause(const Posterior& posterior) {
  if (posterior.unknown > kDiagnosis.naming.probable)
    return {.effect = kUnknown, .probability = posterior.unknown};
  return {.effect = kNone, .probability = posterior.none};
}

CauseResult named_cause(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                        const Posterior& posterior, const std::vector<CauseResult>& causes,
                        const DiagnosisOptions& options) {
  const CauseResult unknown{.effect = kUnknown, .probability = posterior.unknown};
  if (posterior.none >= options.name_below_none) return without_cause(posterior);
  const auto rank = [](const CauseResult& each) {
    return each.of_its_kind() > kDiagnosis.naming.probable ? 1 + each.visible : each.of_its_kind();
  };
  const CauseResult* best = nullptr;
  for (const CauseResult& each : causes)
    if (names_effect(each.effect) && (!best || rank(each) > rank(*best))) best = &each;
  if (!best) return unknown;
  CauseResult known = *best;
  known.together = with_look_alikes_of(linearised, posterior, known);
  if (posterior.unknown < kDiagnosis.naming.probable)
    return posterior.unknown > known.together ? unknown : known;
  if (known.together < kDiagnosis.naming.probable) return unknown;
  const Shares part = shares(evaluator, posterior);
  return part.left > kDiagnosis.naming.most_left * (part.left + part.explained) ? unknown : known;
}

CauseResult decided(CauseResult named, const Posterior& posterior, const ByNoise& p,
                    const DiagnosisOptions& options) {
  const bool structure = p.unknown <= options.name_below_p;
  if (named.effect == kUnknown && structure) return named;
  if (names_effect(named.effect) && p.known <= options.name_below_p) return named;
  if (named.effect != kUnknown && structure && posterior.unknown > kDiagnosis.naming.surely_unknown)
    return {.effect = kUnknown, .probability = posterior.unknown};
  const double noise = named.effect == kUnknown ? p.unknown : p.known;
  return {.effect = kNone,
          .probability = std::max(posterior.none, least_probability_of_none(noise))};
}

CauseResult unless_none(CauseResult verdict, const std::vector<CauseResult>& causes,
                        const DiagnosisOptions& options) {
  const auto none = std::ranges::find(causes, kNone, &CauseResult::effect);
  if (!names_effect(verdict.effect) || none == causes.end() ||
      none->probability < options.name_below_none)
    return verdict;
  return {.effect = kNone, .probability = none->probability};
}

double share_of_structure(double p, double name_below_p) {
  const double none = kDiagnosis.naming.no_structure;
  return std::clamp(std::log(none / p) / std::log(none / name_below_p), 0.0, 1.0);
}

std::vector<CauseResult> with_look_alikes(const LinearisedModel& linearised,
                                          const Posterior& posterior,
                                          std::vector<CauseResult> causes) {
  std::vector<std::string> sure;  // these are there beside it, not in its place
  for (const CauseResult& each : causes)
    for (const std::string& at : each.where)
      if (each.of_its_kind() >= kDiagnosis.naming.sure) sure.push_back(label(each.effect, at));
  for (CauseResult& each : causes) {
    if (!names_effect(each.effect) || each.probability <= kDiagnosis.naming.probable ||
        each.of_its_kind() >= kDiagnosis.naming.sure)
      continue;
    std::vector<std::string> alike;
    for (const std::string& at : each.where) alike.push_back(label(each.effect, at));
    std::ranges::copy_if(
        each.confounded_with, std::back_inserter(alike),
        [&](const std::string& other) { return !std::ranges::count(sure, other); });
    const double together = probability_of_any(linearised, posterior, [&](const Candidate& c) {
      return std::ranges::count(alike, label(c.effect, c.at)) > 0;
    });
    each.together = std::max(each.together, together);
  }
  return causes;
}

std::vector<CauseResult> sure_causes(const std::vector<CauseResult>& causes,
                                     const CauseResult& verdict, const ByNoise& p,
                                     const DiagnosisOptions& options) {
  std::vector<CauseResult> list;
  if (verdict.effect == kNone) return list;
  if (p.known <= options.name_below_p)
    std::ranges::copy_if(causes, std::back_inserter(list), [&](const CauseResult& each) {
      return names_effect(each.effect) && each.effect != verdict.effect &&
             each.of_its_kind() >= kDiagnosis.naming.sure;
    });
  std::ranges::stable_sort(list, std::ranges::greater{}, &CauseResult::visible);
  if (names_effect(verdict.effect)) list.insert(list.begin(), verdict);
  // Of look-alikes that are sure together alone the first stands for all.
  std::vector<CauseResult> named;
  for (CauseResult& each : list)
    if (each.probability >= kDiagnosis.naming.sure ||
        std::ranges::none_of(named, [&](const CauseResult& other) {
          return is_look_alike(each, other) && other.probability < kDiagnosis.naming.sure;
        }))
      named.push_back(std::move(each));
  return named;
}

std::ptrdiff_t steps_at(const CauseResult& cause, const std::string& at) {
  std::vector<double> moments;
  for (const FoundEffect& found : cause.correction)
    if (found.what.at == at && found.what.shape.moment) moments.push_back(*found.what.shape.moment);
  std::ranges::sort(moments);
  std::ptrdiff_t steps = 0;
  double first = -HUGE_VAL;  // of the step that settles
  for (const double moment : moments) {
    if (moment - first <= cause.settles) continue;
    ++steps;
    first = moment;
  }
  return steps;
}

void doubt_repeated_steps(std::vector<CauseResult>& causes, CauseResult& verdict,
                          std::vector<CauseResult>& named) {
  const auto unknown = std::ranges::find(causes, kUnknown, &CauseResult::effect);
  if (unknown == causes.end()) return;
  double lost = 0;
  const auto lower = [&](CauseResult& each) {
    if (!steps_again(each)) return;
    lost = std::max(lost, (1 - kDiagnosis.naming.steps_again) * each.probability);
    each.probability *= kDiagnosis.naming.steps_again;
    each.together *= kDiagnosis.naming.steps_again;
  };
  std::ranges::for_each(causes, lower);
  std::ranges::for_each(named, lower);
  if (lost == 0) return;
  unknown->probability += (1 - unknown->probability) * lost;
  if (verdict.effect == kUnknown) verdict.probability = unknown->probability;
  if (steps_again(verdict)) {
    lower(verdict);
    const auto other = std::ranges::find_if(named, [](const CauseResult& each) {
      return !steps_again(each) && each.of_its_kind() > kDiagnosis.naming.probable;
    });
    if (other != named.end()) {
      verdict = *other;
      std::rotate(named.begin(), other, other + 1);
    } else if (unknown->probability > verdict.of_its_kind()) {
      verdict = {.effect = kUnknown, .probability = unknown->probability};
    }
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &CauseResult::probability);
}

void let_the_larger_share_lead(CauseResult& verdict, std::vector<CauseResult>& named) {
  const auto is_verdict = [&](const CauseResult& each) {
    return each.effect == verdict.effect && each.where == verdict.where;
  };
  const auto share = [](const CauseResult& each) {
    return (each.closes_alone.value_or(0) + each.closes_beside.value_or(0)) / 2;
  };
  const auto leading = std::ranges::find_if(named, is_verdict);
  if (leading == named.end()) return;
  auto largest = leading;
  for (auto each = named.begin(); each != named.end(); ++each)
    if (each->of_its_kind() > leading->of_its_kind() - kDiagnosis.naming.as_probable &&
        share(*each) > share(*largest))
      largest = each;
  if (share(*largest) < share(*leading) + kDiagnosis.naming.plainly_larger) return;
  verdict = *largest;
  std::rotate(named.begin(), largest, largest + 1);
}

void say_unknown(double probability, std::vector<CauseResult>& causes, CauseResult& verdict) {
  const auto unknown = std::ranges::find(causes, kUnknown, &CauseResult::effect);
  if (unknown != causes.end() && unknown->probability < probability) {
    const double others = (1 - probability) / std::max(1 - unknown->probability, 1e-12);
    for (CauseResult& each : causes) each.probability *= std::min(others, 1.0);
    unknown->probability = probability;
  }
  verdict = {.effect = kUnknown, .probability = probability};
  agree(causes, verdict);
}

void agree(std::vector<CauseResult>& causes, CauseResult& verdict) {
  const auto of = [&](const std::string& effect) {
    return std::ranges::find(causes, effect, &CauseResult::effect);
  };
  const auto none = of(kNone);
  if (verdict.effect == kNone && none != causes.end() && verdict.probability > none->probability) {
    const double others = (1 - verdict.probability) / std::max(1 - none->probability, 1e-12);
    for (CauseResult& each : causes) each.probability *= std::min(others, 1.0);
    none->probability = verdict.probability;
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &CauseResult::probability);
  if (const auto own = of(verdict.effect); own != causes.end())
    verdict.probability = own->probability;
}

}  // namespace selfcal
