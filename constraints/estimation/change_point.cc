// With k equations a row and d the difference of successive rows, whose covariance is 2 sigma² I,
//   sigma² = median of |d|² / (2 c²),   c the median of the chi distribution of k
//   D = n1 n2 / (n1 + n2) |mean1 - mean2|² / sigma²,   D / k ~ F(k, nu) without a step
// nu is 2 over the relative variance of sigma². The splits are counted by Bonferroni. One false row
// among good ones is no step: it is taken for the median of itself and its neighbours.
#include "constraints/estimation/change_point.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

/// nu over the rows: the median of |d|² varies so of two equations; more say more.
constexpr double kFreedomOfARow = 0.6;

double scatter(const Eigen::MatrixXd& rows) {
  std::vector<double> squares;
  for (Eigen::Index i = 1; i < rows.rows(); ++i)
    squares.push_back((rows.row(i) - rows.row(i - 1)).squaredNorm());
  const double c = chi_quantile(static_cast<int>(rows.cols()), 0.5);
  return std::sqrt(median(std::move(squares)) / 2) / c;
}

/// `rows`, those that lie farther from the median of three in a row than one good one in a million
/// replaced by it; a step leaves every row beside one of its own side.
Eigen::MatrixXd without_false_rows(const Eigen::MatrixXd& rows, double sigma) {
  constexpr double kGood = 1 - 1e-6;
  const double limit = chi_quantile(static_cast<int>(rows.cols()), kGood) * sigma;
  Eigen::MatrixXd good = rows;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::Index first = std::clamp<Eigen::Index>(i - 1, 0, rows.rows() - 3);
    Eigen::RowVectorXd middle(rows.cols());
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      middle[k] = median({rows(first, k), rows(first + 1, k), rows(first + 2, k)});
    if ((rows.row(i) - middle).norm() > limit) good.row(i) = middle;
  }
  return good;
}

}  // namespace

std::optional<ChangePoint> change_point(const Eigen::MatrixXd& all, double least_sigma,
                                        int fewest) {
  const Eigen::Index n = all.rows();
  if (n < std::max(2 * fewest, 3)) return std::nullopt;
  const double sigma = std::max(scatter(all), least_sigma);
  const Eigen::MatrixXd rows = without_false_rows(all, sigma);
  const Eigen::RowVectorXd sum = rows.colwise().sum();
  Eigen::RowVectorXd before = rows.topRows(fewest).colwise().sum();
  ChangePoint best;
  double most = -1;
  for (Eigen::Index at = fewest; at <= n - fewest; before += rows.row(at++)) {
    const double n1 = static_cast<double>(at), n2 = static_cast<double>(n - at);
    const Eigen::RowVectorXd step = (sum - before) / n2 - before / n1;
    const double gain = n1 * n2 / (n1 + n2) * step.squaredNorm();
    if (gain <= most) continue;
    most = gain;
    best.at = static_cast<int>(at);
    best.step = step.transpose();
  }
  if (!(most > 0) || !(sigma > 0)) return std::nullopt;
  best.statistic = most / (sigma * sigma);
  const auto k = static_cast<double>(rows.cols());
  const double splits = static_cast<double>(n - 2 * fewest + 1);
  best.p_value = std::min(
      1.0, splits * f_exceeds(best.statistic / k, k, kFreedomOfARow * static_cast<double>(n)));
  return best;
}

}  // namespace selfcal
