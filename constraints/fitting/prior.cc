#include "constraints/fitting/prior.h"

#include <cmath>

#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// Prior sigma of nuisance parameters, in the robot's size or rad.
constexpr double kHardlyKnown = 100;
/// Probability under which the priors are widened.
constexpr double kPriorTest = 0.01;

}  // namespace

std::vector<int> free_columns(const Equations& equations, const Prior& prior) {
  std::vector<int> columns;
  for (int c = 0; c < equations.columns(); ++c)
    if (c >= equations.robot_columns() || prior.free[c]) columns.push_back(c);
  return columns;
}

double prior_weight(const Equations& equations, const Prior& prior, int column) {
  if (column >= equations.robot_columns())
    return 1 / (kHardlyKnown * equations.nuisance_unit(column));
  return prior.use ? 1 / prior.sigma[column] : 0;
}

Eigen::VectorXd prior_precision(const Equations& equations, const Prior& prior) {
  Eigen::VectorXd precision(equations.columns());
  for (int c = 0; c < equations.columns(); ++c)
    precision[c] = std::pow(prior_weight(equations, prior, c), 2);
  return precision;
}

Eigen::MatrixXd triangle_with_priors(const Equations& equations, const Prior& prior,
                                     const std::vector<int>& columns, const Eigen::MatrixXd& R,
                                     const Eigen::VectorXd& xi, bool pull) {
  const Eigen::Index n = static_cast<Eigen::Index>(columns.size()), K = R.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K + n, n + 1);
  A.topRows(K) << R(Eigen::all, columns), R.rightCols(1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int c = columns[static_cast<size_t>(i)];
    A(K + i, i) = prior_weight(equations, prior, c);
    if (pull && c < equations.robot_columns())
      A(K + i, n) = A(K + i, i) * (prior.centre[c] - xi[c]);
  }
  triangularise(A);
  return A.topRows(n + 1);
}

Chi2 prior_chi2(const Robot& robot, const Prior& prior, const Eigen::VectorXd& xi,
                const Eigen::VectorXd& variance) {
  Chi2 chi2;
  for (Eigen::Index i = 0; i < xi.size(); ++i) {
    const Parameter& p = robot.parameters()[static_cast<size_t>(i)];
    if (!prior.free[i] || !is_own(p)) continue;
    chi2.value += std::pow((xi[i] - p.nominal) / p.tolerance, 2);
    chi2.freedom += 1 - variance[i] / std::pow(prior.sigma[i], 2);
  }
  return chi2;
}

double widening(const Chi2& chi2) {
  if (chi2.freedom < 0.5 || !(chi_square_exceeds(chi2.value, chi2.freedom) < kPriorTest)) return 1;
  return std::sqrt(chi2.value / chi2.freedom);
}

}  // namespace selfcal
