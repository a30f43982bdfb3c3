// Which sets of causes are visited.
#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/visited_sets.h"

namespace selfcal {

/// One search: what it has visited so far.
class Search {
 public:
  Search(const EvidenceEvaluator& evaluator, bool coarse)
      : evaluator_(evaluator),
        coarse_(coarse),
        goes_on_(!coarse && evaluator.rule_.extended_further > 0),
        candidates_(static_cast<int>(evaluator.blocks_.size())),
        kept_(evaluator.marginal_likelihoods_.size(), 0),
        visited_(evaluator.numbers_.cause) {}

  Posterior run(int singles, int pairs) {
    visit_singles();
    extend(best_of(1, singles));
    if (goes_on_) extend(best_beside_noise(1));
    visited_.keep_best();
    std::vector<Visit> best_pairs = best_of(2, pairs);
    visit_elsewhere(best_pairs);
    add_exchanged(best_pairs);
    extend(best_pairs);
    if (goes_on_) extend(best_beside_noise(2));
    visited_.keep_best();
    visit_elsewhere(best_of(3, pairs));
    visited_.keep_best();
    if (goes_on_) {
      if (!is_enough()) grow_beside_noise();
      lower_impossible();
    }
    Posterior found = posterior_of(visited_.list(), evaluator_.ingredients());
    found.log_total -= evaluator_.marginal_likelihoods_.front().log_evidence({});
    return found;
  }

 private:
  using Visit = CompactHypothesis;

  double note(Visit visit, double log_evidence) {
    visit.log_weight = log_evidence + evaluator_.log_prior(visit.all(), visit.structure);
    visited_.add(visit);
    return visit.log_weight;
  }

  /// What was noted last is to be judged: it may be among what counts in the end.
  bool counts() const {
    return goes_on_ && visited_.last().log_weight > visited_.top() - kDiagnosis.evidence.counts;
  }

  /// Whether a machine can have what was noted last, from G of its columns.
  void judge(const Hypothesis& h, const Eigen::MatrixXd& G) {
    visited_.last().impossible = evaluator_.is_impossible(h, G);
  }

  bool is_impossible(Visit& visit) const {
    if (!visit.impossible)
      visit.impossible = visit.count > 0 && evaluator_.is_impossible(visit.hypothesis());
    return *visit.impossible;
  }

  /// A candidate cannot come near the best, whatever its size.
  bool hopeless(const MarginalLikelihood& marginal_likelihood, int candidate,
                double log_prior) const {
    return coarse_ && marginal_likelihood.at_most(evaluator_.blocks_[candidate]) + log_prior <
                          visited_.top() - kDiagnosis.evidence.hopeless;
  }

  /// Every candidate alone in every structure; the structures that do best go on.
  void visit_singles() {
    visited_.reserve(static_cast<std::size_t>(evaluator_.structures()) * (candidates_ + 1));
    std::vector<std::pair<double, int>> ranked;
    for (int s = 0; s < evaluator_.structures(); ++s)
      note({.structure = s}, evaluator_.marginal_likelihoods_[s].log_evidence({}));
    for (int s = 0; s < evaluator_.structures(); ++s) {
      double best = visited_.list()[static_cast<std::size_t>(s)].log_weight;
      for (int c = 0; c < candidates_; ++c) {
        if (!evaluator_.seen_[c] ||
            hopeless(evaluator_.marginal_likelihoods_[s], c, evaluator_.log_prior({&c, 1}, s)))
          continue;
        const EvidenceEvaluator::Single single = evaluator_.weigh_alone(s, c);
        Visit one{.structure = s};
        one.add(c, single.size);
        best = std::max(best, note(one, single.log_sum));
        if (counts())
          judge(one.hypothesis(), evaluator_.marginal_likelihoods_[s].gram(evaluator_.blocks_[c]));
      }
      kept_[s] = evaluator_.structure(s).kind == 0;
      if (!kept_[s]) ranked.emplace_back(-best, s);
    }
    std::sort(ranked.begin(), ranked.end());
    for (size_t i = 0; i < ranked.size() && static_cast<int>(i) < evaluator_.rule_.most_structures;
         ++i)
      kept_[ranked[i].second] = 1;
    visited_.keep_best();
  }

  std::vector<Visit> best_of(int size, int most) const {
    return visited_.best_of(size, most, [&](int structure) { return kept_[structure] != 0; });
  }

  /// Where many causes act, each set of few leaves what looks like structure: those beside which
  /// noise stands alone go on as well, or the whole of them is never reached.
  std::vector<Visit> best_beside_noise(int size) const {
    return visited_.best_of(size, evaluator_.rule_.extended_further, [&](int structure) {
      return evaluator_.structure(structure).kind == 0;
    });
  }

  /// The best pair with either cause exchanged for the next best ones: where two causes do better
  /// than one that looks like both, neither pair that leads there may be among the best.
  void add_exchanged(std::vector<Visit>& pairs) {
    if (pairs.empty()) return;
    const Visit best = *visited_.best(2);
    const std::vector<int>& cause = evaluator_.numbers_.cause;
    std::vector<Visit> alone;
    for (const Visit& each : visited_.list())
      if (each.count == 1 && each.structure == best.structure &&
          std::ranges::count(best.all(), each.candidates[0]) > 0)
        alone.push_back(each);
    extend(alone);
    visited_.keep_best_of_all();  // a pair may have been reached from its other cause before
    for (const int out : {best.candidates[0], best.candidates[1]}) {
      const int kept = out == best.candidates[0] ? best.candidates[1] : best.candidates[0];
      const auto beside = [&](const Visit& each) {
        return each.candidates[0] == kept ? each.candidates[1] : each.candidates[0];
      };
      std::vector<const Visit*> others;
      for (const Visit& each : visited_.list())
        if (each.count == 2 && each.structure == best.structure &&
            std::ranges::count(each.all(), kept) > 0 && cause[beside(each)] != cause[out])
          others.push_back(&each);
      std::ranges::sort(others, std::ranges::greater{}, &Visit::log_weight);
      std::vector<int> in;  // causes
      for (const Visit* each : others) {
        const int c = beside(*each);
        if (static_cast<int>(in.size()) == kDiagnosis.evidence.exchanged) break;
        if (std::ranges::count(in, cause[c]) > 0) continue;
        in.push_back(cause[c]);
        if (std::ranges::none_of(pairs, [&](const Visit& p) { return p.key() == each->key(); }))
          pairs.push_back(*each);
      }
    }
  }

  /// One or two candidates explain the rows best, beside noise alone.
  bool is_enough() const {
    const auto best = std::ranges::max_element(visited_.list(), {}, &Visit::log_weight);
    return best == visited_.list().end() ||
           (best->count < 3 && evaluator_.structure(best->structure).kind == 0);
  }

  /// What one joint has the others may have as well: triples that noise alone stands beside, by
  /// further candidates of their families, as long as that makes them more probable. They count
  /// where they make all structure needless.
  void grow_beside_noise() {
    std::vector<Visit> best = best_beside_noise(3);
    while (!best.empty() && best.front().count < kDiagnosis.evidence.most_together) {
      const double before = best.front().log_weight;
      const int count = best.front().count + 1;
      extend(best, Of::same_families);
      visited_.keep_best();
      for (Visit& each : visited_.list())
        if (each.count == count && each.log_weight > before - kDiagnosis.evidence.hopeless)
          is_impossible(each);
      visited_.drop_impossible(count);
      best = best_beside_noise(count);
      std::erase_if(best, [&](const Visit& each) { return each.log_weight <= before; });
    }
  }

  /// Of all that counts, what is impossible counts less.
  void lower_impossible() {
    std::vector<Visit>& all = visited_.list();
    std::vector<char> seen(all.size(), 0);
    for (bool lowered = true; lowered;) {
      lowered = false;
      const double least =
          std::ranges::max(all, {}, &Visit::log_weight).log_weight - kDiagnosis.evidence.counts;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (seen[i] || all[i].log_weight < least) continue;
        seen[i] = 1;
        if (!is_impossible(all[i])) continue;
        all[i].log_weight -= kDiagnosis.evidence.impossible;
        lowered = true;
      }
    }
  }

  /// The set has its family. A step is nothing that several joints have.
  bool is_more_of_the_same(const Visit& set, int c) const {
    return !candidate(c).shape.moment && std::ranges::any_of(set.all(), [&](int have) {
      const std::vector<int>& family = evaluator_.numbers_.family;
      return family[have] == family[c];
    });
  }

  enum class Of { all, same_families };
  void extend(const std::vector<Visit>& from, Of which = Of::all) {
    for (const Visit& each : from) {
      const auto done = [&](const Visit& other) { return other.key() == each.key(); };
      if (which == Of::all && std::ranges::any_of(extended_, done)) continue;
      if (which == Of::all) extended_.push_back(each);
      const Hypothesis h = each.hypothesis();
      const MarginalLikelihood& own = evaluator_.marginal_likelihoods_[h.structure];
      const std::vector<MarginalLikelihood::Term> terms = evaluator_.terms(h);
      const std::vector<int> columns = MarginalLikelihood::unfold(terms).first;
      const Eigen::MatrixXd products = own.products(columns);
      const MarginalLikelihood rest = own.given(terms, products);
      const double held = evaluator_.held(h);
      for (int c = 0; c < candidates_; ++c) {
        if (!evaluator_.seen_[c] || std::ranges::count(each.all(), c) > 0) continue;
        if (which == Of::same_families && !is_more_of_the_same(each, c)) continue;
        Visit more = each;
        more.add(c, 1);
        if (hopeless(rest, c, held + evaluator_.log_prior(more.all(), h.structure))) continue;
        const EvidenceEvaluator::Single single = evaluator_.weigh(rest, c);
        more = each;
        more.add(c, single.size);
        note(more, single.log_sum + held);
        if (counts()) judge(beside(h, c, single.size), with_block(products, columns, own, c));
      }
    }
  }

  static Hypothesis beside(Hypothesis h, int c, double size) {
    h.candidates.push_back(c);
    h.sizes.push_back(size);
    return h;
  }

  /// G of a set's `columns`, whose `products` with all columns are given, and candidate `c` behind
  /// them.
  Eigen::MatrixXd with_block(const Eigen::MatrixXd& products, const std::vector<int>& columns,
                             const MarginalLikelihood& own, int c) const {
    const Block& block = evaluator_.blocks_[c];
    const auto n = static_cast<Eigen::Index>(columns.size()),
               m = static_cast<Eigen::Index>(block.columns.size());
    Eigen::MatrixXd G(n + m, n + m);
    G.topLeftCorner(n, n) = products(Eigen::all, columns);
    G.topRightCorner(n, m) = products(Eigen::all, block.columns);
    G.bottomLeftCorner(m, n) = G.topRightCorner(n, m).transpose();
    G.bottomRightCorner(m, m) = own.gram(block);
    return G;
  }

  /// Sets of causes in all other structures that are kept. Where one cause is missing its share
  /// looks like structure, so that a set may have been reached in a structure that it makes
  /// needless.
  void visit_elsewhere(const std::vector<Visit>& sets) {
    for (const Visit& each : sets)
      for (int s = 0; s < evaluator_.structures(); ++s) {
        if (!kept_[s] || s == each.structure) continue;
        Visit other = each;
        other.structure = s;
        if (visited_.has(other)) continue;
        Hypothesis h = other.hypothesis();
        const Eigen::MatrixXd G = evaluator_.gram(h);
        const double log_evidence = evaluator_.sized(h, G);
        for (int i = 0; i < other.count; ++i) other.sizes[i] = static_cast<float>(h.sizes[i]);
        note(other, log_evidence);
        if (counts()) judge(h, G);
      }
  }

  const Candidate& candidate(int c) const {
    return evaluator_.all_.list[static_cast<std::size_t>(c)];
  }

  const EvidenceEvaluator& evaluator_;
  const bool coarse_;
  const bool goes_on_;  ///< beyond triples, and asks of each set whether a machine can have it
  int candidates_;
  std::vector<char> kept_;  ///< by structure: pairs and triples are tried in it
  VisitedSets visited_;
  std::vector<Visit> extended_;  ///< by every candidate
};

Posterior EvidenceEvaluator::search() const {
  return Search(*this, false).run(rule_.extended_singles, rule_.extended_pairs);
}

Posterior EvidenceEvaluator::search_coarsely(int singles) const {
  return Search(*this, true).run(singles, 0);
}

}  // namespace selfcal
