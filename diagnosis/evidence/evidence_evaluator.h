// Which sets of causes explain the rows, and with what probability: candidates as blocks of columns
// with a common scale, each weighed by its marginal likelihood.
//
// Every single candidate is weighed at every size and with every structure of the unknown; the best
// ones are extended by every other candidate to pairs, the best of these to triples, and triples
// beside noise alone by what their families have at further places. The posterior is the normalised
// evidence of all sets visited times their priors; sets that no machine can have count less.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/candidates.h"
#include "diagnosis/evidence/hypothesis.h"
#include "diagnosis/evidence/marginal_likelihood.h"
#include "diagnosis/evidence/posterior.h"
#include "diagnosis/options.h"

namespace selfcal {

class ProductsOfColumns;

/// Everything that the search needs and that does not depend on y.
class EvidenceEvaluator {
 public:
  EvidenceEvaluator(Whitened rows, std::vector<DiscrepancyCovariance> structures,
                    const Candidates& all, const std::vector<EffectParameter>& parameters,
                    const SearchRule& rule);

  /// The sufficient statistics of several y, one a column, in every structure or in those of noise
  /// alone: enough for best_found().
  using Statistics = std::vector<MarginalLikelihood::Statistics>;
  enum class Of { all, noise_alone };
  Statistics statistics_of(const Eigen::MatrixXd& Y, Of which = Of::all) const;
  /// Exchanges y in the structures that have statistics.
  void condition_on(const Statistics& statistics, Eigen::Index which);
  /// Goes back to that of the rows.
  void condition_on_rows();
  Posterior search() const;
  /// A coarse one: so few singles extended to pairs, and nothing weighed that cannot come within
  /// e^-25 of what explains the rows best.
  Posterior search_coarsely(int singles) const;
  /// The most probable candidate, or that one and the best beside it, in the noise that explains
  /// the rows best without any: the statistic of the null distribution.
  struct Found {
    Hypothesis hypothesis;
    double log_odds = 0;  ///< log evidence times prior over that of none
  };
  Found best_found() const;
  /// The same of each y of the statistics, which are of noise alone. Afterwards y is that of the
  /// rows again.
  std::vector<Found> best_found_in(const Statistics& statistics);
  /// What each column of `Y` as y (no strain on the priors) says without any cause, structures x
  /// columns.
  Eigen::MatrixXd log_evidences_of(const Eigen::MatrixXd& Y) const;
  const EvidenceRows& rows() const { return *rows_; }

  const MarginalLikelihood& marginal_likelihood(int structure) const {
    return marginal_likelihoods_[structure];
  }
  const Block& block(int candidate) const { return blocks_[candidate]; }
  const Candidates& candidates() const { return all_; }
  /// What its sets are made of; refers to this.
  Ingredients ingredients() const;
  const DiscrepancyCovariance& structure(int s) const {
    return marginal_likelihoods_[s].structure();
  }
  /// Variance of the noise in this structure, over that of the rows' whitening.
  double noise_variance(int s) const { return structure(s).noise; }
  int structures() const { return static_cast<int>(marginal_likelihoods_.size()); }
  /// Log evidence of one candidate beside noise alone, over that of none.
  double evidence(int candidate) const;
  /// Share of the candidate's main columns that calibration cannot absorb (0 to 1).
  double beyond_nuisance(int candidate) const { return beyond_nuisance_[candidate]; }
  /// Smallest amplitude whose evidence would stand out, of the first main parameter and in its
  /// unit.
  double detectable(int candidate, double log_evidence) const;
  std::vector<MarginalLikelihood::Term> terms(const Hypothesis& hypothesis) const;
  /// Appends the prior 1 sigma of each of the candidate's own parameters at that size.
  void add_sigma(int candidate, double size, std::vector<double>& to) const;
  /// Log evidence times prior of `h`, by which hypotheses are weighed.
  double log_weight(const Hypothesis& h) const;
  /// `h` with candidates added and dropped as long as that makes it more probable: up to `most`, of
  /// at most five families.
  Hypothesis grow(Hypothesis h, size_t most) const;
  /// It needs of a machine what none has: a size far beyond any usual one, or a sign that physics
  /// does not allow. It stands for something else.
  bool is_impossible(const Hypothesis& h) const;
  /// The same from G of its columns (MarginalLikelihood::gram), the candidates in any order.
  bool is_impossible(const Hypothesis& h, const Eigen::MatrixXd& G) const;

 private:
  friend class Search;
  static constexpr std::array kSizes = kDiagnosis.evidence.sizes;
  struct Single {
    double log_sum = 0, log_best = 0, size = 1;
  };
  double log_prior(std::span<const int> candidates, int structure) const;
  /// One candidate beside what `marginal_likelihood` has, its sizes summed over.
  Single weigh(const MarginalLikelihood& marginal_likelihood, int candidate) const;
  /// The same of a structure by itself: fast where many y are looked at.
  Single weigh_alone(int structure, int candidate) const;
  Single over_sizes(int candidate, std::array<double, kSizes.size()> logs) const;
  double plausibility(int candidate, double size) const;
  /// The noise that explains the rows best without any cause.
  int best_noise() const;
  Hypothesis none(int structure) const;
  Hypothesis best_alone(int structure) const;
  /// Of `one` and it with the best candidate beside it, `rest` being what `one` leaves.
  Found better(const Hypothesis& one, const MarginalLikelihood& rest) const;
  /// Priors of sizes that stay as they are.
  double held(const Hypothesis& h) const;
  double held(int candidate, double size) const;
  /// G of the set's columns.
  Eigen::MatrixXd gram(const Hypothesis& h) const;
  /// Gives each cause the size that is most probable beside the others, one after the other, from
  /// G of their columns. Its log evidence, without the prior of the set.
  double sized(Hypothesis& h, const Eigen::MatrixXd& G) const;
  Hypothesis with(Hypothesis h, int candidate, const MarginalLikelihood& rest) const;
  Hypothesis with_best(const Hypothesis& h, const MarginalLikelihood& rest) const;
  Hypothesis pruned(Hypothesis h, ProductsOfColumns& products) const;
  Hypothesis without_parts(Hypothesis h) const;
  /// One of them holds all that the other has.
  bool overlap(int a, int b) const;
  static Eigen::VectorXd most_possible(const Candidate& candidate,
                                       const std::vector<EffectParameter>& parameters);
  void make_blocks(const std::vector<EffectParameter>& parameters);
  /// The structure's size as what its best explanation leaves says. `AC` and `products` are what
  /// it sees (StructuredRows).
  void agree(MarginalLikelihood& marginal_likelihood, const StructuredRows& seen,
             const Eigen::MatrixXd& AC, const std::vector<double>& products, ObservedRows& own);

  const Candidates& all_;
  const SearchRule rule_;
  const CauseNumbers numbers_;
  std::shared_ptr<const EvidenceRows> rows_;
  std::vector<MarginalLikelihood> marginal_likelihoods_;
  /// By structure, one candidate's after the other; none before many y are seen.
  std::vector<std::vector<double>> spectra_;
  std::vector<std::size_t> spectrum_at_ = {0};  ///< by candidate
  /// Logarithms of the rule's odds, and of each structure's probability.
  struct LogOdds {
    double family = 0, same_family = 0, again = 0, another = 0;
    std::vector<double> structure;
  } log_odds_;
  std::vector<Block> blocks_;
  std::vector<std::array<double, kSizes.size()>> plausibility_;  ///< by candidate, with the prior
  std::vector<double> beyond_nuisance_,
      amplitude_;           ///< amplitude over the usual largest, at size 1
  std::vector<char> seen_;  ///< not absorbed altogether
  /// By candidate, of its main parameters, beyond which no machine has them.
  std::vector<Eigen::VectorXd> most_possible_;
};

}  // namespace selfcal
