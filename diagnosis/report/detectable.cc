#include "diagnosis/report/detectable.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/findings.h"

namespace selfcal {
namespace {

bool moves_nothing(const LinearisedModel& linearised, const Candidate& candidate) {
  const auto first = static_cast<Eigen::Index>(linearised.geometry().parameters().size());
  return std::ranges::all_of(
      candidate.main, [&](int k) { return linearised.all().W.col(first + k).isZero(1e-12); });
}

/// A lock sees the chain behind its joint, which follows from the readings alone.
bool all_under_locks(const DataSet& data) {
  return std::ranges::all_of(data.rows.set, [&](int set) {
    return data.sets[static_cast<size_t>(set)].method->planned() == Planned::lock;
  });
}

std::string why_untestable(const LinearisedModel& linearised, const DataSet& data,
                           const Candidate& candidate) {
  if (!moves_nothing(linearised, candidate)) return "absorbed by calibration on these rows";
  if (all_under_locks(data))
    return "rows under locks are met by the readings alone: it needs touches or measured positions "
           "beside them";
  return "it moves nothing in these rows: it needs " + candidate.needs;
}

}  // namespace

void list_detectable(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                     const DataSet& data, const DiagnosisOptions& options, Diagnosis& into) {
  std::map<Cause, Detectable> best;
  const std::vector<Candidate>& list = linearised.candidates().list;
  for (int c = 0; c < static_cast<int>(list.size()); ++c) {
    if (evaluator.beyond_nuisance(c) < kDiagnosis.report.least_beyond_nuisance) continue;
    const double needed = -std::log(options.name_below_none) -
                          std::log(options.search.family_odds) - list[c].log_prior;
    const Detectable each{list[c].effect, list[c].at,
                          linearised.parameters()[list[c].main.front()].unit,
                          evaluator.detectable(c, needed)};
    const auto [at, made] = best.try_emplace({list[c].effect, list[c].at}, each);
    if (!made && each.smallest < at->second.smallest) at->second = each;
  }
  for (auto& [cause, each] : best) into.detectable.push_back(std::move(each));
  for (const Candidate& each : list)
    if (best.try_emplace({each.effect, each.at}).second)
      into.untestable.push_back({each.effect, each.at, why_untestable(linearised, data, each)});
}

}  // namespace selfcal
