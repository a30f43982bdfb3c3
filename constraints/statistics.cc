// Distributions from Boost.Math; the signed-rank test after Wilcoxon, its exact null by counting
// the subsets of ranks that reach each sum.
#include "constraints/statistics.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace selfcal {
namespace {

/// Of what is asked for by the million: not in long double.
using Fast = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// Beyond it Boost's F loses its digits, and the limit is reached to all of them.
constexpr double kMostFreedom = 1e9;

struct Ranks {
  double positive = 0;  ///< sum of the ranks of positive differences
  double ties = 0;      ///< sum of t^3 - t over groups of equal size
  int count = 0;
};

Ranks rank(std::vector<double> d) {
  std::erase_if(d, [](double each) { return each == 0 || std::isnan(each); });
  std::sort(d.begin(), d.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  Ranks r;
  r.count = static_cast<int>(d.size());
  for (size_t i = 0, end = 0; i < d.size(); i = end) {
    while (end < d.size() && std::abs(d[end]) == std::abs(d[i])) ++end;
    const double t = static_cast<double>(end - i);
    const double mean_rank = (static_cast<double>(i + 1) + static_cast<double>(end)) / 2;
    for (size_t k = i; k < end; ++k)
      if (d[k] > 0) r.positive += mean_rank;
    r.ties += t * t * t - t;
  }
  return r;
}

/// Probability that the sum of a random subset of ranks 1..n (each in it or not with equal chance)
/// reaches `sum`.
double exact_tail(int n, double sum) {
  const int most = n * (n + 1) / 2;
  std::vector<double> chance(most + 1, 0.0);
  chance[0] = 1;
  for (int r = 1; r <= n; ++r)
    for (int s = most; s >= 0; --s) chance[s] = 0.5 * (chance[s] + (s >= r ? chance[s - r] : 0.0));
  double tail = 0;
  for (int s = static_cast<int>(sum); s <= most; ++s) tail += chance[s];
  return tail;
}

}  // namespace

double chi_quantile(int freedom, double probability) {
  struct Known {
    int freedom = 0;
    double probability = 0, quantile = 0;
  };
  thread_local std::array<Known, 8> known;  // asked for once a block, with few different arguments
  Known& entry = known[freedom % known.size()];
  if (entry.freedom != freedom || entry.probability != probability) {
    const boost::math::chi_squared_distribution<double> distribution(freedom);
    entry = {freedom, probability, std::sqrt(boost::math::quantile(distribution, probability))};
  }
  return entry.quantile;
}

double chi_square_exceeds(double value, double freedom) {
  if (!(value > 0 && freedom > 0)) return 1;
  if (std::isinf(value)) return 0;
  return boost::math::cdf(boost::math::complement(
      boost::math::chi_squared_distribution<double>(std::min(freedom, kMostFreedom)), value));
}

double log_chi_square_below(double value, double freedom) {
  // Boost divides by Gamma(freedom / 2 + 1) far below the mean, which overflows.
  constexpr double kFarBelow = 1e-3;
  const double below =
      value > kFarBelow * freedom
          ? boost::math::cdf(boost::math::chi_squared_distribution<double, Fast>(freedom), value)
          : 0;
  if (below > std::numeric_limits<double>::min()) return std::log(below);
  // The incomplete gamma function's series, which far below its mean converges fast.
  const double a = freedom / 2, x = value / 2;
  double sum = 1, term = 1;
  for (double k = 1; term > 1e-12 * sum; ++k) sum += term *= x / (a + k);
  return a * std::log(x) - x - std::lgamma(a + 1) + std::log(sum);
}

double effective_freedoms(const std::vector<VariancePart>& parts) {
  double sum = 0, uncertain = 0;
  for (const VariancePart& part : parts) {
    sum += part.variance;
    uncertain += part.variance * part.variance / (part.freedoms > 1 ? part.freedoms : 1);
  }
  return uncertain > 0 ? sum * sum / uncertain : HUGE_VAL;
}

double f_exceeds(double value, double upper_freedom, double lower_freedom) {
  if (!(value > 0 && upper_freedom > 0 && lower_freedom > 0)) return 1;
  if (std::isinf(value)) return 0;
  const boost::math::fisher_f_distribution<double, Fast> distribution(
      std::min(upper_freedom, kMostFreedom), std::min(lower_freedom, kMostFreedom));
  return boost::math::cdf(boost::math::complement(distribution, value));
}

double student_quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom > 0 ? freedom : 1), probability);
}

double student_below(double value, double freedom) {
  if (std::isnan(value) || !(freedom > 0)) return 0.5;
  return boost::math::cdf(boost::math::students_t_distribution<double, Fast>(freedom), value);
}

double as_many_drawn(unsigned seen, unsigned drawn, unsigned having, unsigned all) {
  if (seen == 0 || seen + all <= having + drawn) return 1;
  const boost::math::hypergeometric_distribution<> draw(having, drawn, all);
  return cdf(complement(draw, seen - 1));
}

double signed_rank_p(const std::vector<double>& differences) {
  const Ranks r = rank(differences);
  if (r.count == 0) return 1;
  if (r.count <= 50 && r.ties == 0) return exact_tail(r.count, r.positive);
  const double n = r.count, mean = n * (n + 1) / 4;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - r.ties / 48;
  const double z = (r.positive - mean - 0.5) / std::sqrt(variance);
  return boost::math::cdf(boost::math::complement(boost::math::normal_distribution<double>(), z));
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace selfcal
