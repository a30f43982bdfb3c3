#include "diagnosis/evidence/posterior.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "kinematics/expects.h"

namespace selfcal {
namespace {

/// Probabilities of families and causes (by number), set by set.
class SharedOut {
 public:
  explicit SharedOut(const Ingredients& of)
      : of_(of), family_(of.candidates.list.size()), cause_(of.candidates.list.size()) {}

  void add(const CompactHypothesis& set, Posterior& posterior) {
    const double p = std::exp(set.log_weight);
    const bool unknown = of_.unknown[static_cast<std::size_t>(set.structure)] != 0;
    double meant = 1;  // all that it has
    for (const int c : set.all()) meant *= candidate(c).meant;
    posterior.unknown += unknown ? p : p * (1 - meant);
    if (!unknown && set.count == 0) posterior.none += p;
    add_once(set, p, of_.numbers.family, family_);
    add_once(set, p, of_.numbers.cause, cause_);
  }

  void tell(Posterior& posterior) const {
    for (std::size_t at = 0; at < family_.size(); ++at) {
      const Candidate& named = candidate(static_cast<int>(at));
      if (family_[at] > 0) posterior.family[named.effect] = family_[at];
      if (cause_[at] > 0) posterior.cause[{named.effect, named.at}] = cause_[at];
    }
  }

 private:
  const Candidate& candidate(int c) const {
    return of_.candidates.list[static_cast<std::size_t>(c)];
  }

  void add_once(const CompactHypothesis& set, double p, const std::vector<int>& numbers,
                std::vector<double>& to) const {
    const auto number = [&](int c) { return numbers[static_cast<std::size_t>(c)]; };
    const std::span<const int> all = set.all();
    for (auto c = all.begin(); c != all.end(); ++c) {
      const int mine = number(*c);
      if (std::any_of(all.begin(), c, [&](int before) { return number(before) == mine; })) continue;
      to[static_cast<std::size_t>(mine)] += p * candidate(*c).meant;
    }
  }

  const Ingredients& of_;
  std::vector<double> family_, cause_;
};

/// The most probable first: all that are possible, the best one with each candidate, and of noise
/// alone and of structure.
std::vector<const CompactHypothesis*> worth_telling(const std::vector<CompactHypothesis>& visited,
                                                    const Ingredients& of) {
  std::vector<const CompactHypothesis*> best(of.candidates.list.size() + 2, nullptr), list;
  const auto look = [&](std::size_t at, const CompactHypothesis& each) {
    if (!best[at] || each.log_weight > best[at]->log_weight) best[at] = &each;
  };
  for (const CompactHypothesis& each : visited) {
    if (each.log_weight > -kDiagnosis.evidence.hardly_possible) list.push_back(&each);
    look(of.unknown[static_cast<std::size_t>(each.structure)] ? 0 : 1, each);
    for (const int c : each.all()) look(static_cast<std::size_t>(c) + 2, each);
  }
  for (const CompactHypothesis* each : best)
    if (each && each->log_weight <= -kDiagnosis.evidence.hardly_possible) list.push_back(each);
  std::ranges::sort(list, [](const CompactHypothesis* a, const CompactHypothesis* b) {
    return a->log_weight != b->log_weight ? a->log_weight > b->log_weight : a < b;
  });
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

CauseNumbers::CauseNumbers(const Candidates& candidates) {
  for (const Candidate& candidate : candidates.list) {
    const auto first = [&](auto named) {
      return static_cast<int>(std::ranges::find(candidates.list, named(candidate), named) -
                              candidates.list.begin());
    };
    family.push_back(first([](const Candidate& each) { return each.effect; }));
    cause.push_back(first([](const Candidate& each) { return Cause{each.effect, each.at}; }));
  }
}

Posterior posterior_of(std::vector<CompactHypothesis>& visited, const Ingredients& of) {
  double top = -INFINITY, sum = 0;
  for (const CompactHypothesis& each : visited) top = std::max(top, each.log_weight);
  for (const CompactHypothesis& each : visited) sum += std::exp(each.log_weight - top);
  const double total = top + std::log(sum);
  expects(std::isfinite(total), "the evidence of finite rows is finite");
  Posterior posterior;
  posterior.log_total = total;
  SharedOut shared(of);
  for (CompactHypothesis& each : visited) {
    each.log_weight -= total;
    shared.add(each, posterior);
  }
  for (const CompactHypothesis* each : worth_telling(visited, of))
    posterior.hypotheses.push_back(each->hypothesis());
  shared.tell(posterior);
  return posterior;
}

Posterior with_less_structure(const Posterior& all, double kept, const Ingredients& of) {
  const auto is_structured = [&](const Hypothesis& h) {
    return of.unknown[static_cast<std::size_t>(h.structure)] != 0;
  };
  double without = 0;
  for (const Hypothesis& h : all.hypotheses)
    if (!is_structured(h)) without += std::exp(h.log_weight);
  std::vector<CompactHypothesis> visited;
  for (const Hypothesis& h : all.hypotheses) {
    if (is_structured(h) && kept <= 0) continue;
    visited.push_back(compact(h));
    visited.back().log_weight += std::log(is_structured(h) ? kept : kept + (1 - kept) / without);
  }
  Posterior rest = posterior_of(visited, of);
  rest.log_total += all.log_total;
  return rest;
}

}  // namespace selfcal
