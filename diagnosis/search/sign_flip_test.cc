#include "diagnosis/search/sign_flip_test.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/rows.h"

namespace selfcal {
namespace {

using SignRandom = std::mt19937_64;

double drawn_sign(SignRandom& random) { return (random() & 1) ? 1 : -1; }

/// `residual` with one sign for each configuration, and one for each equation that no row carries.
Eigen::VectorXd flipped(const Eigen::VectorXd& residual, const DenseEquations& kept,
                        const Observations& data, SignRandom& random) {
  const std::vector<int> configuration = configurations(data);
  std::map<int, double> sign;  // by configuration
  Eigen::VectorXd out = residual;
  for (Eigen::Index e = 0; e < out.size(); ++e) {
    const int row = kept.row[static_cast<size_t>(e)];
    if (row < 0) {
      out[e] *= drawn_sign(random);
      continue;
    }
    const auto [found, made] = sign.try_emplace(configuration[row], 0.0);
    if (made) found->second = drawn_sign(random);
    out[e] *= found->second;
  }
  return out;
}

/// How much the best of `evaluator` in `y` gains by the search's own outliers, which it finds
/// farther from its best explanation than noise reaches: up to a share of `most` of `count` rows.
double gain_of_outliers(const EvidenceEvaluator& evaluator, const Hypothesis& best,
                        const Eigen::VectorXd& y, const DenseEquations& kept, std::size_t count,
                        double most) {
  if (best.candidates.empty()) return 0;
  const auto terms = evaluator.terms(best);
  const auto [columns, sigma] = MarginalLikelihood::unfold(terms);
  const std::vector<char> far =
      outliers_among(kept, evaluator.rows().left_of(y, columns, sigma),
                     static_cast<double>(evaluator.rows().rows().A.cols()), count, most);
  std::vector<int> out;
  for (size_t e = 0; e < kept.row.size(); ++e)
    if (kept.row[e] >= 0 && far[kept.row[e]]) out.push_back(static_cast<int>(e));
  return evaluator.marginal_likelihood(best.structure).gained_without(terms, y, out);
}

/// Residuals dealt out anew to the rows of a set, each row's as a whole and with a sign of its own.
class Dealer {
 public:
  Dealer(const DenseEquations& kept, const Observations& data) {
    std::map<std::pair<int, size_t>, std::vector<std::vector<Eigen::Index>>> alike;
    for (size_t e = 0; e < kept.row.size();) {
      size_t end = e + 1;
      while (end < kept.row.size() && kept.row[end] == kept.row[e]) ++end;
      std::vector<Eigen::Index> of_row(end - e);
      std::iota(of_row.begin(), of_row.end(), static_cast<Eigen::Index>(e));
      if (kept.row[e] >= 0) alike[{data.set[kept.row[e]], end - e}].push_back(std::move(of_row));
      e = end;
    }
    for (auto& [key, rows] : alike) groups_.push_back(std::move(rows));
  }

  Eigen::VectorXd dealt(const Eigen::VectorXd& residual, SignRandom& random) const {
    Eigen::VectorXd out = residual;
    for (const auto& rows : groups_) {
      std::vector<size_t> from(rows.size());
      std::iota(from.begin(), from.end(), size_t{0});
      std::shuffle(from.begin(), from.end(), random);
      for (size_t i = 0; i < rows.size(); ++i) {
        const double sign = drawn_sign(random);
        for (size_t k = 0; k < rows[i].size(); ++k)
          out[rows[i][k]] = sign * residual[rows[from[i]][k]];
      }
    }
    return out;
  }

 private:
  std::vector<std::vector<std::vector<Eigen::Index>>> groups_;  ///< rows alike, their equations
};

/// Of each column of `Y`: log evidence times prior of the most probable structure over that of the
/// most probable noise.
Eigen::ArrayXd found_structure(const EvidenceEvaluator& evaluator, const Eigen::MatrixXd& Y) {
  Eigen::ArrayXd noise = Eigen::ArrayXd::Constant(Y.cols(), -INFINITY), structure = noise;
  const Eigen::MatrixXd all = evaluator.log_evidences_of(Y);
  for (int s = 0; s < evaluator.structures(); ++s) {
    const Eigen::ArrayXd log =
        all.row(s).transpose().array() + std::log(evaluator.structure(s).probability);
    Eigen::ArrayXd& best = evaluator.structure(s).kind == 0 ? noise : structure;
    best = best.max(log);
  }
  return structure - noise;
}

/// Probability beyond `seen` by the tail of `found`, all below it: logs of odds fall off
/// exponentially (Markov: P(odds > k) <= 1/k), how fast by the mean excess of the best of them,
/// taken two sigma slower (Knijnenburg et al., Bioinformatics 25 (2009), with shape 0). 1 where
/// they are too few.
double beyond_tail(std::vector<double> found, double seen) {
  std::ranges::sort(found, std::ranges::greater{});
  const auto best =
      static_cast<std::size_t>(kDiagnosis.naming.of_tail * static_cast<double>(found.size()));
  if (best < kDiagnosis.naming.fewest_of_tail || !std::isfinite(found[best])) return 1;
  const double from = found[best], count = static_cast<double>(best);
  const double excess = std::accumulate(found.begin(), found.begin() + best, 0.0) / count - from;
  if (!(excess > 0)) return 1;
  const double slowly = excess * (1 + 2 / std::sqrt(count));
  const double p = count / static_cast<double>(found.size()) * std::exp((from - seen) / slowly);
  return std::max(p, kDiagnosis.naming.least_p);
}

}  // namespace

double share_as_good(const std::vector<double>& found, double seen) {
  const auto as_good = std::ranges::count_if(found, [&](double each) { return each >= seen; });
  const double share =
      (1.0 + static_cast<double>(as_good)) / (1.0 + static_cast<double>(found.size()));
  return as_good > 0 ? share : std::min(share, beyond_tail(found, seen));
}

NullDistribution::NullDistribution(const LinearisedModel& linearised, EvidenceEvaluator& evaluator,
                                   const Observations& data, int resamples, unsigned long long seed,
                                   double most_outliers) {
  const DenseEquations kept = linearised.kept();
  const Eigen::VectorXd residual = linearised.geometry_residuals(evaluator.rows().rows());
  SignRandom random(seed);
  Eigen::MatrixXd Y(residual.size(), resamples);
  for (int i = 0; i < resamples; ++i) Y.col(i) = flipped(residual, kept, data, random);
  const auto found =
      evaluator.best_found_in(evaluator.statistics_of(Y, EvidenceEvaluator::Of::noise_alone));
  for (int i = 0; i < resamples; ++i) {
    const EvidenceEvaluator::Found& best = found[static_cast<std::size_t>(i)];
    const double gain = gain_of_outliers(evaluator, best.hypothesis, Y.col(i), kept,
                                         static_cast<std::size_t>(data.rows()), most_outliers);
    found_.push_back(best.log_odds + std::max(0.0, gain));
  }
}

double p_of_unknown(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
                    const Hypothesis& known, const Observations& data, int resamples,
                    unsigned long long seed) {
  Whitened rows = linearised.whitened_geometry();
  const DenseEquations kept = linearised.kept();
  if (!known.candidates.empty()) {
    const auto terms = evaluator.terms(known);
    rows.y -= evaluator.rows().rows().C(Eigen::all, MarginalLikelihood::unfold(terms).first) *
              evaluator.marginal_likelihood(known.structure).estimate(terms).mean;
  }
  const Eigen::VectorXd residual = linearised.geometry_residuals(rows);
  // What the geometry takes of a row's noise is given back, so that one row's is as good as
  // another's.
  const Eigen::VectorXd noise = residual.cwiseQuotient(
      linearised.geometry_leaves(rows).cwiseMax(kDiagnosis.naming.least_of_row).cwiseSqrt());
  const Dealer dealer(kept, data);
  SignRandom random(seed);
  Eigen::MatrixXd Y(residual.size(), resamples);
  for (int i = 0; i < resamples; ++i) Y.col(i) = dealer.dealt(noise, random);
  const Eigen::ArrayXd found = found_structure(evaluator, Y);
  return share_as_good({found.begin(), found.end()}, found_structure(evaluator, residual)[0]);
}

double least_probability_of_none(double p) {
  if (p >= 1 / std::numbers::e) return 0.5;
  return 1 / (1 - 1 / (std::numbers::e * p * std::log(p)));
}

}  // namespace selfcal
