// The most probable candidate, or that one and the best beside it: the statistic that a null
// distribution is made of, of one y or of many.
#include <cmath>
#include <set>

#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {

EvidenceEvaluator::Statistics EvidenceEvaluator::statistics_of(const Eigen::MatrixXd& Y,
                                                               Of which) const {
  Statistics statistics(marginal_likelihoods_.size());
  ObservedRows observed(*rows_, Y, true);
  for (std::size_t s = 0; s < statistics.size(); ++s)
    if (which == Of::all || marginal_likelihoods_[s].structure().kind == 0)
      statistics[s] = marginal_likelihoods_[s].statistics_of(observed);
  return statistics;
}

void EvidenceEvaluator::condition_on(const Statistics& statistics, Eigen::Index which) {
  for (std::size_t s = 0; s < statistics.size(); ++s) {
    if (statistics[s].g.cols() == 0) continue;
    marginal_likelihoods_[s].condition_on(statistics[s], which);
    if (!spectra_[s].empty()) continue;
    spectra_[s].reserve(spectrum_at_.back());
    for (const Block& block : blocks_)
      marginal_likelihoods_[s].add_spectrum(block, kSizes, spectra_[s]);
  }
}

void EvidenceEvaluator::condition_on_rows() {
  for (MarginalLikelihood& each : marginal_likelihoods_) each.condition_on_rows();
}

Eigen::MatrixXd EvidenceEvaluator::log_evidences_of(const Eigen::MatrixXd& Y) const {
  Eigen::MatrixXd all(structures(), Y.cols());
  ObservedRows observed(*rows_, Y, false);
  for (int s = 0; s < structures(); ++s)
    all.row(s) = marginal_likelihoods_[s].log_evidences_of(observed).transpose();
  return all;
}

int EvidenceEvaluator::best_noise() const {
  int home = 0;
  for (int s = 1; s < structures(); ++s)
    if (structure(s).kind == 0 &&
        marginal_likelihoods_[s].log_evidence({}) > marginal_likelihoods_[home].log_evidence({}))
      home = s;
  return home;
}

Hypothesis EvidenceEvaluator::none(int structure) const {
  return {{},
          structure,
          marginal_likelihoods_[structure].log_evidence({}) + log_prior({}, structure),
          {}};
}

EvidenceEvaluator::Found EvidenceEvaluator::best_found() const {
  const int home = best_noise();
  const Hypothesis one = best_alone(home);
  if (one.candidates.empty()) return {one, -INFINITY};
  return better(one, marginal_likelihoods_[home].given(terms(one)));
}

EvidenceEvaluator::Found EvidenceEvaluator::better(const Hypothesis& one,
                                                   const MarginalLikelihood& rest) const {
  const Hypothesis two = with_best(one, rest);
  const Hypothesis& best = two.log_weight > one.log_weight ? two : one;
  return {best, best.log_weight - none(one.structure).log_weight};
}

std::vector<EvidenceEvaluator::Found> EvidenceEvaluator::best_found_in(
    const Statistics& statistics) {
  Eigen::Index count = 0;
  for (const MarginalLikelihood::Statistics& each : statistics)
    count = std::max(count, each.yy.size());
  std::vector<Hypothesis> ones;
  std::vector<std::set<int>> columns(statistics.size());  // of those, by structure
  for (Eigen::Index i = 0; i < count; ++i) {
    condition_on(statistics, i);
    ones.push_back(best_alone(best_noise()));
    for (const int column : MarginalLikelihood::unfold(terms(ones.back())).first)
      columns[ones.back().structure].insert(column);
  }
  // Products with those columns, all at once: one after the other they cost ten times as much.
  std::vector<std::vector<int>> list(statistics.size());
  std::vector<Eigen::MatrixXd> products(statistics.size());
  for (std::size_t s = 0; s < statistics.size(); ++s) {
    list[s].assign(columns[s].begin(), columns[s].end());
    if (!list[s].empty()) products[s] = marginal_likelihoods_[s].products(list[s]);
  }
  std::vector<Found> found;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Hypothesis& one = ones[static_cast<std::size_t>(i)];
    if (one.candidates.empty()) {
      found.push_back({one, -INFINITY});
      continue;
    }
    condition_on(statistics, i);
    std::vector<int> at;
    for (const int column : MarginalLikelihood::unfold(terms(one)).first)
      at.push_back(static_cast<int>(std::ranges::lower_bound(list[one.structure], column) -
                                    list[one.structure].begin()));
    found.push_back(better(one, marginal_likelihoods_[one.structure].given(
                                    terms(one), products[one.structure](at, Eigen::all))));
  }
  condition_on_rows();
  return found;
}

/// The most probable candidate beside noise alone; none of them where none is seen.
Hypothesis EvidenceEvaluator::best_alone(int structure) const {
  Hypothesis best = none(structure);
  int chosen = -1;
  Single as;
  for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
    if (!seen_[c]) continue;
    const double prior = log_prior({&c, 1}, structure);
    if (marginal_likelihoods_[structure].at_most(blocks_[c]) + prior <= best.log_weight &&
        chosen >= 0)
      continue;
    const Single single = weigh_alone(structure, c);
    const double weight = single.log_sum + prior;
    if (chosen >= 0 && weight <= best.log_weight) continue;
    best.log_weight = weight;
    chosen = c;
    as = single;
  }
  if (chosen < 0) return best;
  best.candidates = {chosen};
  best.sizes = {as.size};
  return best;
}

/// `h` and one candidate more, `rest` being what `h` leaves.
Hypothesis EvidenceEvaluator::with(Hypothesis h, int candidate,
                                   const MarginalLikelihood& rest) const {
  const Single single = weigh(rest, candidate);
  const double before = held(h);
  h.candidates.push_back(candidate);
  h.sizes.push_back(single.size);
  h.log_weight = single.log_sum + before + log_prior(h.candidates, h.structure);
  return h;
}

/// `h` and the candidate that makes it most probable, `rest` being what `h` leaves; `h` alone where
/// there is none.
Hypothesis EvidenceEvaluator::with_best(const Hypothesis& h, const MarginalLikelihood& rest) const {
  Hypothesis more = h;
  more.candidates.push_back(-1);
  const double before = held(h);
  double best = -INFINITY, size = 1;
  int chosen = -1;
  for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
    if (!seen_[c] || std::ranges::count(h.candidates, c) > 0) continue;
    more.candidates.back() = c;
    const double other = before + log_prior(more.candidates, h.structure);
    if (chosen >= 0 && rest.at_most(blocks_[c]) + other <= best) continue;
    const Single single = weigh(rest, c);
    const double weight = single.log_sum + other;
    if (chosen >= 0 && weight <= best) continue;
    best = weight;
    chosen = c;
    size = single.size;
  }
  if (chosen < 0) return h;
  more.candidates.back() = chosen;
  more.sizes.push_back(size);
  more.log_weight = best;
  return more;
}

}  // namespace selfcal
