// Candidates as blocks of columns with a common scale, and what one of them is worth.
#include "diagnosis/evidence/evidence_evaluator.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "kinematics/effect.h"

namespace selfcal {
namespace {

double middle(const EffectParameter& p) { return std::sqrt(p.usual_least * p.usual_most); }

double log_prior_of_size(double size) {
  constexpr auto& sizes = kDiagnosis.evidence.sizes;
  constexpr double huge = kDiagnosis.evidence.huge;
  return std::log(size == sizes.back() ? huge : (1 - huge) / (sizes.size() - 1.0));
}

}  // namespace

EvidenceEvaluator::EvidenceEvaluator(Whitened rows, std::vector<DiscrepancyCovariance> structures,
                                     const Candidates& all,
                                     const std::vector<EffectParameter>& parameters,
                                     const SearchRule& rule)
    : all_(all), rule_(rule), numbers_(all) {
  Groups groups;
  for (const Candidate& candidate : all.list) {
    groups.push_back(candidate.main);
    for (const SlackParameters& slack : candidate.slack)
      groups.back().insert(groups.back().end(), slack.list.begin(), slack.list.end());
  }
  rows_ = std::make_shared<const EvidenceRows>(std::make_shared<const Whitened>(std::move(rows)),
                                               groups);
  marginal_likelihoods_.reserve(structures.size());
  StructuredRows seen{.rows = rows_};
  ObservedRows own(*rows_, rows_->rows().y, true);
  for (DiscrepancyCovariance& structure : structures) {
    seen.take(structure);
    const Eigen::MatrixXd AC = seen.AC();
    const std::vector<double> products = seen.products();
    marginal_likelihoods_.emplace_back(seen, structure, AC, products, own);
    if (blocks_.empty()) make_blocks(parameters);
    if (!rule_.noise_is_known) agree(marginal_likelihoods_.back(), seen, AC, products, own);
  }
  spectra_.resize(marginal_likelihoods_.size());
  log_odds_ = {std::log(rule_.family_odds),
               std::log(rule_.same_family),
               std::log(rule_.again),
               std::log(rule_.another),
               {}};
  for (int s = 0; s < this->structures(); ++s)
    log_odds_.structure.push_back(std::log(structure(s).probability) +
                                  (structure(s).kind > 0 ? std::log(rule_.unknown_odds) : 0));
}

Ingredients EvidenceEvaluator::ingredients() const {
  Ingredients of{all_, numbers_, {}};
  for (int s = 0; s < structures(); ++s) of.unknown.push_back(structure(s).kind > 0);
  return of;
}

/// What is moved at will may be moved as far as one likes; and what comes to be elsewhere farther
/// than any machine's tells of an instrument that was moved.
Eigen::VectorXd EvidenceEvaluator::most_possible(const Candidate& candidate,
                                                 const std::vector<EffectParameter>& parameters) {
  Eigen::VectorXd most =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(candidate.main.size()), INFINITY);
  const EffectLasting lasting = lasting_of(candidate.effect);
  if (lasting == EffectLasting::moved_at_will || lasting == EffectLasting::moves) return most;
  for (Eigen::Index i = 0; i < most.size(); ++i)
    most[i] = kDiagnosis.report.impossible *
              parameters[static_cast<size_t>(candidate.main[static_cast<size_t>(i)])].usual_most;
  return most;
}

/// Each candidate's columns in units that are visible alike beyond the geometry and noise alone.
void EvidenceEvaluator::make_blocks(const std::vector<EffectParameter>& parameters) {
  const Whitened& rows = rows_->rows();
  const MarginalLikelihood& plain = marginal_likelihoods_.front();
  const auto n = static_cast<double>(rows.C.rows());
  for (const Candidate& candidate : all_.list) {
    Block block;
    most_possible_.push_back(most_possible(candidate, parameters));
    std::vector<double> unit;
    double visible = 0, whole = 0, largest = 0;
    for (size_t i = 0; i < candidate.main.size(); ++i) {
      const int k = candidate.main[i];
      const auto at = static_cast<Eigen::Index>(i);
      const double u = middle(parameters[static_cast<size_t>(k)]);
      visible += u * u * plain.product(static_cast<int>(blocks_.size()), at, at);
      whole += u * u * rows.C.col(k).squaredNorm();
      largest = std::max(largest, u / parameters[static_cast<size_t>(k)].usual_most);
    }
    beyond_nuisance_.push_back(whole > 0 ? std::sqrt(std::max(visible, 0.0) / whole) : 0);
    seen_.push_back(beyond_nuisance_.back() > kDiagnosis.evidence.least_seen);
    const double scale = seen_.back() ? std::sqrt(n / visible) : 0;
    amplitude_.push_back(scale * largest);
    for (const int k : candidate.main) {
      block.columns.push_back(k);
      unit.push_back(scale * middle(parameters[static_cast<size_t>(k)]));
      if (parameters[static_cast<size_t>(k)].positive)
        block.positive.push_back(static_cast<int>(unit.size()) - 1);
    }
    for (const SlackParameters& slack : candidate.slack) {
      double squares = 0;
      for (const int k : slack.list) squares += rows.C.col(k).squaredNorm();
      for (const int k : slack.list) {
        block.columns.push_back(k);
        unit.push_back(squares > 0 ? slack.doubt * scale * std::sqrt(whole / squares) : 0);
      }
    }
    block.unit =
        Eigen::Map<const Eigen::VectorXd>(unit.data(), static_cast<Eigen::Index>(unit.size()));
    block.group = static_cast<int>(blocks_.size());
    plausibility_.emplace_back();
    for (std::size_t i = 0; i < kSizes.size(); ++i)
      plausibility_.back()[i] = plausibility(block.group, kSizes[i]) + log_prior_of_size(kSizes[i]);
    spectrum_at_.push_back(spectrum_at_.back() +
                           MarginalLikelihood::spectrum_size(block, kSizes.size()));
    blocks_.push_back(std::move(block));
  }
}

/// The geometry's priors weigh rightly only where the noise does: the structure's size is taken
/// from what its best explanation leaves, where that is an equation at least.
void EvidenceEvaluator::agree(MarginalLikelihood& marginal_likelihood, const StructuredRows& seen,
                              const Eigen::MatrixXd& AC, const std::vector<double>& products,
                              ObservedRows& own) {
  for (int i = 0; i < kDiagnosis.evidence.agreements && marginal_likelihood.freedom() >= 1; ++i) {
    double best = marginal_likelihood.log_evidence({});
    double variance = marginal_likelihood.estimate({}).variance;
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      if (!seen_[c] ||
          marginal_likelihood.at_most(blocks_[c]) - kDiagnosis.evidence.worthwhile < best)
        continue;
      const Single single = weigh(marginal_likelihood, c);
      if (single.log_sum - kDiagnosis.evidence.worthwhile < best) continue;
      best = single.log_sum - kDiagnosis.evidence.worthwhile;
      const MarginalLikelihood::Term term{&blocks_[c], single.size};
      variance = marginal_likelihood.estimate({&term, 1}).variance;
    }
    if (std::abs(std::log(variance)) < 0.1) return;
    DiscrepancyCovariance agreed = marginal_likelihood.structure();
    agreed.noise *= variance;
    marginal_likelihood = MarginalLikelihood(seen, std::move(agreed), AC, products, own);
  }
}

double EvidenceEvaluator::plausibility(int candidate, double size) const {
  const double beyond = std::log10(size * amplitude_[candidate] / kDiagnosis.evidence.as_usual);
  return beyond > 0 ? -kDiagnosis.evidence.tenfold * beyond * beyond : 0;
}

double EvidenceEvaluator::log_prior(std::span<const int> candidates, int structure) const {
  double sum = 0;
  int families = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const int c = candidates[i];
    sum += all_.list[static_cast<size_t>(c)].log_prior;
    const auto has = [&](const std::vector<int>& number) {
      for (std::size_t j = 0; j < i; ++j)
        if (number[candidates[j]] == number[c]) return true;
      return false;
    };
    if (has(numbers_.cause))
      sum += log_odds_.again;
    else if (has(numbers_.family))
      sum += log_odds_.same_family;
    else
      sum += log_odds_.family + (++families > 1 ? log_odds_.another : 0);
  }
  sum += log_odds_.structure[static_cast<size_t>(structure)];
  return this->structure(structure).kind == 0 || families == 0 ? sum : sum + log_odds_.another;
}

/// The sum over sizes of the logs of a candidate's evidence, each with what it costs.
EvidenceEvaluator::Single EvidenceEvaluator::over_sizes(
    int candidate, std::array<double, kSizes.size()> logs) const {
  Single single{0, -INFINITY, 1};
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    logs[i] += plausibility_[candidate][i];
    if (logs[i] <= single.log_best) continue;
    single.log_best = logs[i];
    single.size = kSizes[i];
  }
  if (std::isinf(single.log_best)) return {-INFINITY, -INFINITY, 1};
  for (const double log : logs) single.log_sum += std::exp(log - single.log_best);
  single.log_sum = single.log_best + std::log(single.log_sum);
  return single;
}

EvidenceEvaluator::Single EvidenceEvaluator::weigh(const MarginalLikelihood& marginal_likelihood,
                                                   int candidate) const {
  std::array<double, kSizes.size()> logs{};
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    const MarginalLikelihood::Term term{&blocks_[candidate], kSizes[i]};
    logs[i] = marginal_likelihood.log_evidence({&term, 1});
  }
  return over_sizes(candidate, logs);
}

EvidenceEvaluator::Single EvidenceEvaluator::weigh_alone(int structure, int candidate) const {
  const MarginalLikelihood& own = marginal_likelihoods_[structure];
  if (spectra_[structure].empty() || blocks_[candidate].columns.size() > kMostLooped)
    return weigh(own, candidate);
  std::array<double, kSizes.size()> logs{};
  own.log_evidences(blocks_[candidate], kSizes,
                    &spectra_[structure][spectrum_at_[static_cast<std::size_t>(candidate)]],
                    logs.data());
  return over_sizes(candidate, logs);
}

Eigen::MatrixXd EvidenceEvaluator::gram(const Hypothesis& h) const {
  return marginal_likelihoods_[h.structure].gram(MarginalLikelihood::unfold(terms(h)).first);
}

double EvidenceEvaluator::sized(Hypothesis& h, const Eigen::MatrixXd& G) const {
  const MarginalLikelihood& own = marginal_likelihoods_[h.structure];
  double log_evidence = -INFINITY;
  for (std::size_t i = 0; i < h.candidates.size(); ++i) {
    std::array<double, kSizes.size()> logs{};
    for (std::size_t k = 0; k < kSizes.size(); ++k) {
      h.sizes[i] = kSizes[k];
      logs[k] = own.log_evidence(terms(h), G);
    }
    const Single single = over_sizes(h.candidates[i], logs);
    h.sizes[i] = single.size;
    log_evidence = single.log_sum + held(h) - held(h.candidates[i], h.sizes[i]);
  }
  return log_evidence;
}

double EvidenceEvaluator::held(int candidate, double size) const {
  // It stays at the best of the grid, about two of which matter.
  return plausibility(candidate, size) + log_prior_of_size(size) + std::log(2.0);
}

double EvidenceEvaluator::held(const Hypothesis& h) const {
  double sum = 0;
  for (size_t i = 0; i < h.candidates.size(); ++i) sum += held(h.candidates[i], h.sizes[i]);
  return sum;
}

double EvidenceEvaluator::log_weight(const Hypothesis& h) const {
  return marginal_likelihoods_[h.structure].log_evidence(terms(h)) + held(h) +
         log_prior(h.candidates, h.structure);
}

double EvidenceEvaluator::evidence(int candidate) const {
  return seen_[candidate] ? weigh(marginal_likelihoods_.front(), candidate).log_sum -
                                marginal_likelihoods_.front().log_evidence({})
                          : 0;
}

std::vector<MarginalLikelihood::Term> EvidenceEvaluator::terms(const Hypothesis& hypothesis) const {
  std::vector<MarginalLikelihood::Term> list;
  for (size_t i = 0; i < hypothesis.candidates.size(); ++i)
    list.push_back({&blocks_[hypothesis.candidates[i]], hypothesis.sizes[i]});
  return list;
}

void EvidenceEvaluator::add_sigma(int candidate, double size, std::vector<double>& to) const {
  for (size_t i = 0; i < all_.list[candidate].main.size(); ++i)
    to.push_back(size * blocks_[candidate].unit[static_cast<Eigen::Index>(i)]);
}

double EvidenceEvaluator::detectable(int candidate, double log_evidence) const {
  // A cause of visible size r adds about n r^2 / 2 to the log evidence.
  const double r = std::sqrt(2 * log_evidence / marginal_likelihoods_.front().freedom());
  return r * blocks_[candidate].unit[0];
}

}  // namespace selfcal
