// How sure what is named may be beside what no list of causes has.
#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/search/naming.h"

namespace selfcal {
namespace {

/// What may be a drift or go along with the rows' order is half unknown for that alone.
bool may_be_order(const CauseResult& each) {
  return std::ranges::count(each.confounded_with, kUnknown) > 0;
}

/// How probably the list of causes lacks one.
double lacking(const std::vector<CauseResult>& causes) {
  double by_order = 0, unknown = 0;
  for (const CauseResult& each : causes) {
    if (may_be_order(each)) by_order = std::max(by_order, each.together - each.probability);
    if (each.effect == kUnknown) unknown = each.probability;
  }
  return std::max(unknown - by_order, 0.0);
}

/// How probably it is another cause, which no list has and which looks the same: the less of it is
/// seen, the less do the rows tell the one law from the other, by the squares that these differ by.
double imitated(const CauseResult& each) {
  constexpr auto& naming = kDiagnosis.naming;
  const double seen = std::clamp(each.visible * each.visible, 1e-6, 1.0);
  return std::min(naming.imitated / seen, naming.mostly_imitated);
}

}  // namespace

void allow_for_the_unknown(std::vector<CauseResult>& causes, CauseResult& verdict,
                           std::vector<CauseResult>& named, double left) {
  if (std::ranges::find(causes, kUnknown, &CauseResult::effect) == causes.end()) return;
  const double beside = 1 - kDiagnosis.naming.beside_unknown *
                                std::clamp(left / kDiagnosis.naming.hardly_left, 0.0, 1.0) *
                                lacking(causes);
  const auto lower = [&](CauseResult& each) {
    if (!names_effect(each.effect)) return;
    const double kept = (1 - imitated(each)) * (may_be_order(each) ? 1 : beside);
    each.probability *= kept;
    each.together *= kept;
  };
  std::ranges::for_each(causes, lower);
  std::ranges::for_each(named, lower);
  lower(verdict);
  let_the_larger_lead(causes, left, verdict);
  std::ranges::stable_sort(causes, std::ranges::greater{}, &CauseResult::probability);
}

void let_the_larger_lead(const std::vector<CauseResult>& causes, double left,
                         CauseResult& verdict) {
  const auto unknown = std::ranges::find(causes, kUnknown, &CauseResult::effect);
  if (unknown == causes.end() || !names_effect(verdict.effect)) return;
  const bool hardly = verdict.of_its_kind() < kDiagnosis.naming.probable;
  if ((left > kDiagnosis.naming.most_left || hardly) &&
      verdict.of_its_kind() < std::min(kDiagnosis.naming.sure, lacking(causes)))
    verdict = {.effect = kUnknown, .probability = unknown->probability};
}

void bound_by_what_is_left(const Gap& gap, std::vector<CauseResult>& causes, CauseResult& verdict,
                           std::vector<CauseResult>& named) {
  if (named.empty() || gap.rows == 0 || !gap.closed.fraction || !std::isfinite(gap.closed.most) ||
      gap.rms_after <= kDiagnosis.naming.plainly_left * gap.noise_floor)
    return;
  const double most = std::clamp(gap.closed.most, 0.0, 1.0);
  const auto bound = [&](CauseResult& each) {
    if (!names_effect(each.effect)) return;
    each.probability = std::min(each.probability, most);
    each.together = std::min(each.together, most);
  };
  std::ranges::for_each(causes, bound);
  std::ranges::for_each(named, bound);
  bound(verdict);
  const auto unknown = std::ranges::find(causes, kUnknown, &CauseResult::effect);
  if (unknown == causes.end())
    causes.push_back({.effect = kUnknown, .probability = 1 - most});
  else
    unknown->probability = std::max(unknown->probability, 1 - most);
  let_the_larger_lead(causes, 1 - *gap.closed.fraction, verdict);
  std::ranges::stable_sort(causes, std::ranges::greater{}, &CauseResult::probability);
}

}  // namespace selfcal
