// Candidates as blocks of columns with a common scale, and what each of them is worth.
#include "diagnosis/evidence/search.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kLeastSeen = 1e-3;  ///< share that survives below which a candidate says nothing
constexpr int kAgreements = 3;
constexpr double kWorthwhile = 5;  ///< log evidence that a cause must bring to be reckoned with

double log_add(double a, double b) {
  const double top = std::max(a, b);
  return std::isinf(top) ? top : top + std::log(std::exp(a - top) + std::exp(b - top));
}

double middle(const EffectParameter& p) { return std::sqrt(p.usual_least * p.usual_most); }

}  // namespace

const std::vector<double>& EvidenceEvaluator::sizes() {
  static const std::vector<double> list{0.25, 0.5, 1, 2, 4, 8, 16};
  return list;
}

EvidenceEvaluator::EvidenceEvaluator(const Whitened& rows,
                                     std::vector<DiscrepancyCovariance> structures,
                                     const Candidates& all,
                                     const std::vector<EffectParameter>& parameters,
                                     const SearchRule& rule)
    : all_(all), rule_(rule) {
  rows_ = std::make_shared<const Whitened>(rows);
  auto groups = std::make_shared<Groups>();
  for (const Candidate& candidate : all.list) {
    groups->push_back(candidate.main);
    groups->back().insert(groups->back().end(), candidate.slack.begin(), candidate.slack.end());
  }
  groups_ = std::move(groups);
  number_causes();
  marginal_likelihoods_.reserve(structures.size());
  for (DiscrepancyCovariance& structure : structures) {
    Columns columns(*rows_, structure.root);
    marginal_likelihoods_.emplace_back(rows_, std::move(structure), groups_, columns);
    if (blocks_.empty()) make_blocks(parameters);
    if (!rule_.noise_is_known) agree(marginal_likelihoods_.back(), std::move(columns));
  }
}

void EvidenceEvaluator::number_causes() {
  for (const Candidate& candidate : all_.list) {
    const auto first = [&](auto of) {
      return static_cast<int>(std::ranges::find(all_.list, of(candidate), of) - all_.list.begin());
    };
    family_.push_back(first([](const Candidate& each) { return each.effect; }));
    cause_.push_back(first([](const Candidate& each) { return Cause{each.effect, each.at}; }));
  }
}

/// Each candidate's columns in units that are visible alike beyond the geometry and noise alone.
void EvidenceEvaluator::make_blocks(const std::vector<EffectParameter>& parameters) {
  const Whitened& rows = *rows_;
  const auto n = static_cast<double>(rows.C.rows());
  for (const Candidate& candidate : all_.list) {
    Block block;
    std::vector<double> unit;
    double visible = 0, whole = 0, largest = 0;
    const Eigen::VectorXd seen =
        marginal_likelihoods_.front().gram(candidate.main, candidate.main).diagonal();
    for (Eigen::Index i = 0; i < seen.size(); ++i) {
      const int k = candidate.main[static_cast<size_t>(i)];
      const double u = middle(parameters[static_cast<size_t>(k)]);
      visible += u * u * seen[i];
      whole += u * u * rows.C.col(k).squaredNorm();
      largest = std::max(largest, u / parameters[static_cast<size_t>(k)].usual_most);
    }
    survival_.push_back(whole > 0 ? std::sqrt(std::max(visible, 0.0) / whole) : 0);
    seen_.push_back(survival_.back() > kLeastSeen);
    const double scale = seen_.back() ? std::sqrt(n / visible) : 0;
    amplitude_.push_back(scale * largest);
    for (const int k : candidate.main) {
      block.columns.push_back(k);
      unit.push_back(scale * middle(parameters[static_cast<size_t>(k)]));
      if (parameters[static_cast<size_t>(k)].positive)
        block.positive.push_back(static_cast<int>(unit.size()) - 1);
    }
    double slack = 0;
    for (const int k : candidate.slack) slack += rows.C.col(k).squaredNorm();
    for (const int k : candidate.slack) {
      block.columns.push_back(k);
      unit.push_back(slack > 0 ? candidate.doubt * scale * std::sqrt(whole / slack) : 0);
    }
    block.unit =
        Eigen::Map<const Eigen::VectorXd>(unit.data(), static_cast<Eigen::Index>(unit.size()));
    block.group = static_cast<int>(blocks_.size());
    blocks_.push_back(std::move(block));
  }
}

/// The geometry's priors weigh rightly only where the noise does: the structure's size is taken
/// from what its best explanation leaves.
void EvidenceEvaluator::agree(MarginalLikelihood& marginal_likelihood, Columns columns) {
  for (int i = 0; i < kAgreements; ++i) {
    double best = marginal_likelihood.log_evidence({});
    double variance = marginal_likelihood.estimate({}).variance;
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      if (!seen_[c]) continue;
      const Single single = weigh(marginal_likelihood, c);
      if (single.log_sum - kWorthwhile < best) continue;
      best = single.log_sum - kWorthwhile;
      const MarginalLikelihood::Term term{&blocks_[c], single.size};
      variance = marginal_likelihood.estimate({&term, 1}).variance;
    }
    if (std::abs(std::log(variance)) < 0.1) return;
    DiscrepancyCovariance agreed = marginal_likelihood.structure();
    agreed.root *= std::sqrt(variance);
    agreed.noise *= variance;
    columns.A /= std::sqrt(variance);
    columns.C /= std::sqrt(variance);
    marginal_likelihood = MarginalLikelihood(rows_, std::move(agreed), groups_, columns);
  }
}

EvidenceEvaluator::Views EvidenceEvaluator::views_of(const Eigen::MatrixXd& Y, Of which) const {
  Views views(marginal_likelihoods_.size());
  for (std::size_t s = 0; s < views.size(); ++s)
    if (which == Of::all || marginal_likelihoods_[s].structure().kind == 0)
      views[s] = marginal_likelihoods_[s].views_of(Y);
  return views;
}

void EvidenceEvaluator::look_at(const Views& views, Eigen::Index which) {
  for (std::size_t s = 0; s < views.size(); ++s)
    if (views[s].g.cols() > 0) marginal_likelihoods_[s].look_at(views[s], which);
}

void EvidenceEvaluator::look_at_rows() {
  for (MarginalLikelihood& each : marginal_likelihoods_) each.look_at_rows();
}

double EvidenceEvaluator::plausibility(int candidate, double size) const {
  // Three times the usual largest is as good as any; ten times that costs two.
  const double beyond = std::log10(size * amplitude_[candidate] / 3);
  return beyond > 0 ? -2 * beyond * beyond : 0;
}

double EvidenceEvaluator::log_prior(std::span<const int> candidates, int structure) const {
  double sum = 0;
  int families = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const int c = candidates[i];
    sum += all_.list[static_cast<size_t>(c)].log_prior;
    const auto has = [&](const std::vector<int>& number) {
      return std::ranges::any_of(candidates.first(i),
                                 [&](int other) { return number[other] == number[c]; });
    };
    if (has(cause_) || has(family_))
      sum += std::log(rule_.same_family);
    else
      sum += std::log(rule_.family_odds) + (++families > 1 ? std::log(rule_.another) : 0);
  }
  sum += std::log(this->structure(structure).probability);
  if (this->structure(structure).kind == 0) return sum;
  return sum + std::log(rule_.unknown_odds) + (families == 0 ? 0 : std::log(rule_.another));
}

EvidenceEvaluator::Single EvidenceEvaluator::weigh(const MarginalLikelihood& marginal_likelihood,
                                                   int candidate) const {
  Single single{-INFINITY, -INFINITY, 1};
  for (const double size : sizes()) {
    const MarginalLikelihood::Term term{&blocks_[candidate], size};
    const double log = marginal_likelihood.log_evidence({&term, 1}) +
                       plausibility(candidate, size) -
                       std::log(static_cast<double>(sizes().size()));
    single.log_sum = log_add(single.log_sum, log);
    if (log > single.log_best) {
      single.log_best = log;
      single.size = size;
    }
  }
  return single;
}

double EvidenceEvaluator::held(const Hypothesis& h) const {
  // The sizes of candidates at hand stay at their best: one of the grid, about two of which matter.
  double sum = 0;
  for (size_t i = 0; i < h.candidates.size(); ++i)
    sum += plausibility(h.candidates[i], h.sizes[i]) -
           std::log(static_cast<double>(sizes().size()) / 2);
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

EvidenceEvaluator::Found EvidenceEvaluator::best_found() const {
  int home = 0;
  for (int s = 1; s < structures(); ++s)
    if (structure(s).kind == 0 &&
        marginal_likelihoods_[s].log_evidence({}) > marginal_likelihoods_[home].log_evidence({}))
      home = s;
  const Hypothesis none{
      {}, home, marginal_likelihoods_[home].log_evidence({}) + log_prior({}, home), {}};
  const Hypothesis one = with_best(none, marginal_likelihoods_[home]);
  if (one.candidates.empty()) return {none, -INFINITY};
  const Hypothesis two = with_best(one, marginal_likelihoods_[home].given(terms(one)));
  const Hypothesis& best = two.log_weight > one.log_weight ? two : one;
  return {best, best.log_weight - none.log_weight};
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
  Hypothesis best = h;
  for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
    if (!seen_[c] || std::ranges::count(h.candidates, c) > 0) continue;
    Hypothesis more = with(h, c, rest);
    if (best.candidates.size() == h.candidates.size() || more.log_weight > best.log_weight)
      best = std::move(more);
  }
  return best;
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
