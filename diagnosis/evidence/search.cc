// The sets of causes that are visited, and their posterior.
#include "diagnosis/evidence/search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace selfcal {
namespace {

constexpr size_t kMostFamilies = 5;  ///< that a set of causes grows to

}  // namespace

/// One search on a bench: what it has visited so far.
class Search {
 public:
  explicit Search(const EvidenceEvaluator& bench)
      : bench_(bench),
        candidates_(static_cast<int>(bench.blocks_.size())),
        kept_(bench.marginal_likelihoods_.size(), 0) {}

  Posterior run(int singles, int pairs) {
    visit_singles();
    extend(best_of(1, singles));
    extend(best_of(2, pairs));
    return posterior();
  }

 private:
  const Candidate& candidate(int c) const { return bench_.all_.list[static_cast<size_t>(c)]; }

  /// Notes a hypothesis, the best of those with the same candidates and structure; its weight.
  double note(const Hypothesis& of, double log_evidence) {
    std::vector<size_t> order(of.candidates.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return of.candidates[a] < of.candidates[b]; });
    Hypothesis h;
    h.structure = of.structure;
    for (const size_t i : order) {
      h.candidates.push_back(of.candidates[i]);
      h.sizes.push_back(of.sizes[i]);
    }
    h.log_weight = log_evidence + bench_.log_prior(h.candidates, h.structure);
    Hypothesis& slot = visited_[{h.candidates, h.structure}];
    if (slot.candidates.empty() || h.log_weight > slot.log_weight) slot = h;
    return slot.log_weight;
  }

  /// Every candidate alone in every structure; the structures that do best go on.
  void visit_singles() {
    std::vector<std::pair<double, int>> ranked;
    for (int s = 0; s < bench_.structures(); ++s) {
      const MarginalLikelihood& marginal_likelihood = bench_.marginal_likelihoods_[s];
      double best = note({{}, s, 0, {}}, marginal_likelihood.log_evidence({}));
      for (int c = 0; c < candidates_; ++c) {
        if (!bench_.seen_[c]) continue;
        const EvidenceEvaluator::Single single = bench_.weigh(marginal_likelihood, c);
        best = std::max(best, note({{c}, s, 0, {single.size}}, single.log_sum));
      }
      kept_[s] = bench_.structure(s).kind == 0;
      if (!kept_[s]) ranked.emplace_back(-best, s);
    }
    std::sort(ranked.begin(), ranked.end());
    for (size_t i = 0; i < ranked.size() && static_cast<int>(i) < bench_.rule_.most_structures; ++i)
      kept_[ranked[i].second] = 1;
  }

  /// The best of `size` candidates. Not one cause in all its shapes: two of each cause and
  /// structure.
  std::vector<Hypothesis> best_of(size_t size, int most) const {
    std::vector<Hypothesis> list;
    for (const auto& [key, h] : visited_)
      if (h.candidates.size() == size && kept_[h.structure]) list.push_back(h);
    std::sort(list.begin(), list.end(), more_probable);
    std::map<std::pair<std::vector<Cause>, int>, int> taken;
    std::vector<Hypothesis> diverse;
    for (const Hypothesis& h : list) {
      std::vector<Cause> causes;
      for (const int c : h.candidates) causes.emplace_back(candidate(c).effect, candidate(c).at);
      if (++taken[{causes, h.structure}] > 2) continue;
      if (static_cast<int>(diverse.size()) >= most) break;
      diverse.push_back(h);
    }
    return diverse;
  }

  void extend(const std::vector<Hypothesis>& from) {
    for (const Hypothesis& h : from) {
      const MarginalLikelihood rest =
          bench_.marginal_likelihoods_[h.structure].given(bench_.terms(h));
      for (int c = 0; c < candidates_; ++c) {
        if (!bench_.seen_[c] || std::count(h.candidates.begin(), h.candidates.end(), c)) continue;
        const EvidenceEvaluator::Single single = bench_.weigh(rest, c);
        Hypothesis more = h;
        more.candidates.push_back(c);
        more.sizes.push_back(single.size);
        note(more, single.log_sum + bench_.held(h));
      }
    }
  }

  Posterior posterior() const {
    Posterior posterior;
    for (const auto& [key, h] : visited_) posterior.hypotheses.push_back(h);
    std::sort(posterior.hypotheses.begin(), posterior.hypotheses.end(), more_probable);
    const double top = posterior.hypotheses.front().log_weight;
    double sum = 0;
    for (const Hypothesis& h : posterior.hypotheses) sum += std::exp(h.log_weight - top);
    const double total = top + std::log(sum);
    posterior.log_total = total - bench_.marginal_likelihoods_.front().log_evidence({});
    for (Hypothesis& h : posterior.hypotheses) {
      h.log_weight -= total;
      share_out(h, posterior);
    }
    return posterior;
  }

  void share_out(const Hypothesis& h, Posterior& posterior) const {
    const double p = std::exp(h.log_weight);
    const bool unknown = bench_.structure(h.structure).kind > 0;
    if (unknown) posterior.unknown += p;
    if (!unknown && h.candidates.empty()) posterior.none += p;
    std::set<std::string> families;
    std::set<Cause> causes;
    for (const int c : h.candidates) {
      families.insert(candidate(c).effect);
      causes.insert({candidate(c).effect, candidate(c).at});
    }
    for (const std::string& f : families) posterior.family[f] += p;
    for (const Cause& c : causes) posterior.cause[c] += p;
  }

  static bool more_probable(const Hypothesis& a, const Hypothesis& b) {
    return a.log_weight > b.log_weight;
  }

  const EvidenceEvaluator& bench_;
  int candidates_;
  std::vector<char> kept_;  ///< by structure: pairs and triples are tried in it
  std::map<std::pair<std::vector<int>, int>, Hypothesis> visited_;
};

Posterior EvidenceEvaluator::search(int singles, int pairs) const {
  return Search(*this).run(singles, pairs);
}

/// Without one candidate after the other, as long as that makes it more probable.
Hypothesis EvidenceEvaluator::pruned(Hypothesis h) const {
  const MarginalLikelihood& marginal_likelihood = marginal_likelihoods_[h.structure];
  const std::vector<int> all = MarginalLikelihood::unfold(terms(h)).first;
  const Eigen::MatrixXd G = marginal_likelihood.gram(all, all);
  const auto weigh_again = [&](Hypothesis& of) {
    const std::vector<MarginalLikelihood::Term> list = terms(of);
    std::vector<int> at;  // of its columns, among all
    for (const int column : MarginalLikelihood::unfold(list).first)
      at.push_back(static_cast<int>(std::ranges::find(all, column) - all.begin()));
    of.log_weight = marginal_likelihood.log_evidence(list, G(at, at)) + held(of) +
                    log_prior(of.candidates, of.structure);
  };
  weigh_again(h);
  for (size_t i = 0; i + 1 < h.candidates.size(); ++i) {
    Hypothesis less = h;
    less.candidates.erase(less.candidates.begin() + static_cast<std::ptrdiff_t>(i));
    less.sizes.erase(less.sizes.begin() + static_cast<std::ptrdiff_t>(i));
    weigh_again(less);
    if (less.log_weight <= h.log_weight) continue;
    h = less;
    --i;
  }
  return h;
}

bool EvidenceEvaluator::overlap(int a, int b) const {
  const std::vector<int>&p = all_.list[static_cast<size_t>(a)].main,
        &q = all_.list[static_cast<size_t>(b)].main;
  const auto within = [](const std::vector<int>& less, const std::vector<int>& more) {
    return std::ranges::all_of(less, [&](int i) { return std::ranges::count(more, i) > 0; });
  };
  return within(p, q) || within(q, p);
}

/// Without those that the last one holds.
Hypothesis EvidenceEvaluator::without_parts(Hypothesis h) const {
  const int last = h.candidates.back();
  for (size_t i = h.candidates.size() - 1; i-- > 0;)
    if (overlap(h.candidates[i], last)) {
      h.candidates.erase(h.candidates.begin() + static_cast<std::ptrdiff_t>(i));
      h.sizes.erase(h.sizes.begin() + static_cast<std::ptrdiff_t>(i));
    }
  return h;
}

Hypothesis EvidenceEvaluator::grow(Hypothesis h, size_t most) const {
  h.log_weight = marginal_likelihoods_[h.structure].given(terms(h)).log_evidence({}) + held(h) +
                 log_prior(h.candidates, h.structure);
  while (h.candidates.size() < most) {
    const MarginalLikelihood rest = marginal_likelihoods_[h.structure].given(terms(h));
    std::set<std::string> families;
    for (const int c : h.candidates) families.insert(all_.list[static_cast<size_t>(c)].effect);
    Hypothesis best = h;
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      // What a part of it has is dropped below; what holds it already needs no part again.
      if (!seen_[c] || std::ranges::any_of(h.candidates, [&](int have) {
            return overlap(c, have) && blocks_[have].columns.size() >= blocks_[c].columns.size();
          }))
        continue;
      if (families.size() >= kMostFamilies &&
          !families.contains(all_.list[static_cast<size_t>(c)].effect))
        continue;
      Hypothesis more = with(h, c, rest);
      if (more.log_weight > best.log_weight + 1) best = std::move(more);
    }
    if (best.candidates.size() == h.candidates.size()) break;
    h = pruned(without_parts(std::move(best)));
  }
  return h;
}

}  // namespace selfcal
