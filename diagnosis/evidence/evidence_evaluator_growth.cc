// A set of causes that grows as far as it goes: each candidate that makes it more probable, without
// those that others make up for; and whether a machine can have a set.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {

/// Rows of G as a growing set asks for them: those of a column are made once.
class ProductsOfColumns {
 public:
  explicit ProductsOfColumns(const MarginalLikelihood& of) : of_(of) {}

  /// `columns` by all columns of G.
  Eigen::MatrixXd rows(const std::vector<int>& columns) {
    std::vector<int> missing;
    for (const int column : columns)
      if (!at_.contains(column)) missing.push_back(column);
    if (!missing.empty()) {
      const Eigen::MatrixXd more = of_.products(missing);
      for (std::size_t i = 0; i < missing.size(); ++i)
        at_[missing[i]] = more.row(static_cast<Eigen::Index>(i));
    }
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(columns.size()), of_.rows().rows().C.cols());
    for (std::size_t i = 0; i < columns.size(); ++i)
      rows.row(static_cast<Eigen::Index>(i)) = at_.at(columns[i]);
    return rows;
  }

 private:
  const MarginalLikelihood& of_;
  std::map<int, Eigen::RowVectorXd> at_;
};

/// Without one candidate after the other, as long as that makes it more probable.
Hypothesis EvidenceEvaluator::pruned(Hypothesis h, ProductsOfColumns& products) const {
  const MarginalLikelihood& marginal_likelihood = marginal_likelihoods_[h.structure];
  const std::vector<int> all = MarginalLikelihood::unfold(terms(h)).first;
  const Eigen::MatrixXd G = products.rows(all)(Eigen::all, all);
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
  const MarginalLikelihood& own = marginal_likelihoods_[h.structure];
  ProductsOfColumns products(own);
  const auto left_by = [&](const Hypothesis& of) {
    return of.candidates.empty()
               ? own
               : own.given(terms(of), products.rows(MarginalLikelihood::unfold(terms(of)).first));
  };
  h.log_weight = left_by(h).log_evidence({}) + held(h) + log_prior(h.candidates, h.structure);
  while (h.candidates.size() < most) {
    const MarginalLikelihood rest = left_by(h);
    std::set<std::string> families;
    for (const int c : h.candidates) families.insert(all_.list[static_cast<size_t>(c)].effect);
    Hypothesis best = h;
    for (int c = 0; c < static_cast<int>(blocks_.size()); ++c) {
      // What a part of it has is dropped below; what holds it already needs no part again.
      if (!seen_[c] || std::ranges::any_of(h.candidates, [&](int have) {
            return overlap(c, have) && blocks_[have].columns.size() >= blocks_[c].columns.size();
          }))
        continue;
      if (families.size() >= kDiagnosis.evidence.most_families &&
          !families.contains(all_.list[static_cast<size_t>(c)].effect))
        continue;
      Hypothesis more = with(h, c, rest);
      if (more.log_weight > best.log_weight + 1) best = std::move(more);
    }
    if (best.candidates.size() == h.candidates.size()) break;
    h = pruned(without_parts(std::move(best)), products);
  }
  return h;
}

bool EvidenceEvaluator::is_impossible(const Hypothesis& h) const {
  return is_impossible(h, gram(h));
}

bool EvidenceEvaluator::is_impossible(const Hypothesis& h, const Eigen::MatrixXd& G) const {
  const MarginalLikelihood::Estimate estimate =
      marginal_likelihoods_[h.structure].estimate(terms(h), G);
  Eigen::Index first = 0;
  for (const int c : h.candidates) {
    const Block& block = blocks_[c];
    const Eigen::VectorXd& most = most_possible_[static_cast<std::size_t>(c)];
    const auto sigma = [&](Eigen::Index at) {
      return std::sqrt(estimate.variance * estimate.covariance(at, at));
    };
    for (Eigen::Index i = 0; i < most.size(); ++i)
      if (std::abs(estimate.mean[first + i]) - kDiagnosis.report.sigmas * sigma(first + i) >
          most[i])
        return true;
    for (const int i : block.positive)
      if (estimate.mean[first + i] + kDiagnosis.report.other_sign * sigma(first + i) < 0)
        return true;
    first += static_cast<Eigen::Index>(block.columns.size());
  }
  return false;
}

}  // namespace selfcal
