#include "diagnosis/search/sign_flip_test.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace selfcal {

NullDistribution::NullDistribution(const LinearisedModel& view, EvidenceEvaluator& bench,
                                   const Observations& data, int resamples,
                                   unsigned long long seed) {
  const Whitened rows = view.whitened();
  const DenseEquations kept = view.kept();
  const Eigen::VectorXd residual = view.geometry_residuals(rows);
  std::mt19937_64 random(seed);
  const Eigen::VectorXd no_pull = Eigen::VectorXd::Zero(rows.pull.size());
  for (int i = 0; i < resamples; ++i) {
    std::map<std::pair<int, int>, double> sign;  // by repeat group, or by row
    Eigen::VectorXd flipped = residual;
    for (Eigen::Index e = 0; e < flipped.size(); ++e) {
      const int row = kept.row[static_cast<size_t>(e)];
      const bool repeated = row >= 0 && !data.repeat.empty() && data.repeat[row] >= 0;
      const std::pair<int, int> key = repeated ? std::pair(1, data.repeat[row]) : std::pair(0, row);
      const auto [found, made] = sign.try_emplace(key, 0.0);
      if (made) found->second = (random() & 1) ? 1 : -1;
      flipped[e] *= found->second;
    }
    bench.look_at(flipped, no_pull, true);
    found_.push_back(bench.best_found());
  }
  bench.look_at(rows.y, rows.pull);
}

double NullDistribution::p_of(double found) const {
  const auto as_good = std::ranges::count_if(found_, [&](double each) { return each >= found; });
  return (1.0 + static_cast<double>(as_good)) / (1.0 + static_cast<double>(found_.size()));
}

double least_probability_of_none(double p) {
  if (p >= 1 / std::numbers::e) return 0.5;
  return 1 / (1 - 1 / (std::numbers::e * p * std::log(p)));
}

}  // namespace selfcal
