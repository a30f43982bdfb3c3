// A row that identified nothing is predicted by parameters that are known with covariance C:
// whitened, its residuals have the covariance I + W C W^T, W its derivatives over its noise.
#include "constraints/estimation/prediction.h"

#include <cmath>
#include <cstddef>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr std::ptrdiff_t kMost = 2000;  // rows that are asked about

/// Whether the fit's covariance has all that a row of the set is predicted by.
bool is_predicted(const Equations& fit_equations, const Judged& after, int set) {
  const Method& method = *fit_equations.data().sets[set].method;
  return after.aligned[set] == 0 && method.group_freedom() == 0 && !method.shares_touches() &&
         (method.tangent_dimension() == 0 || fit_equations.tangent_dimension(set) > 0);
}

/// Derivatives by the columns of `fit` instead of those of `check`.
Eigen::MatrixXd in_columns_of(const Equations& fit, const Equations& check,
                              const Eigen::MatrixXd& W) {
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(W.rows(), fit.columns());
  moved.leftCols(fit.robot_columns()) = W.leftCols(fit.robot_columns());
  for (int set = 0; set < static_cast<int>(fit.data().sets.size()); ++set)
    if (const int own = fit.tangent_dimension(set); own > 0 && own == check.tangent_dimension(set))
      moved.middleCols(fit.own_at(set), own) = W.middleCols(check.own_at(set), own);
  return moved;
}

}  // namespace

std::vector<char> foreseen(const DataSet& data, const Equations& fit_equations,
                           const Eigen::MatrixXd& C, const Judged& after) {
  std::vector<char> explained(after.check.size(), 0);
  std::vector<char> others(static_cast<size_t>(data.rows.rows()), 1);
  std::vector<std::size_t> of_row(others.size());
  std::ptrdiff_t asked = 0;
  for (std::size_t i = 0; i < after.check.size() && asked < kMost; ++i) {
    const RowResidual& r = after.check[i];
    if (!is_outlier(r, after) || !is_predicted(fit_equations, after, r.set)) continue;
    others[static_cast<size_t>(r.row)] = 0;
    of_row[static_cast<size_t>(r.row)] = i;
    ++asked;
  }
  if (asked == 0) return explained;
  const Equations check(fit_equations.robot(), data, Use::check);
  const DenseEquations dense = check.dense(after.state, after.check_scale, others);
  const Eigen::MatrixXd W = in_columns_of(fit_equations, check, dense.W);
  for (Eigen::Index first = 0, end = 0; first < W.rows(); first = end) {
    const int row = dense.row[static_cast<size_t>(first)];
    while (end < W.rows() && dense.row[static_cast<size_t>(end)] == row) ++end;
    if (row < 0) continue;
    const Eigen::MatrixXd own = W.middleRows(first, end - first);
    const Eigen::MatrixXd spread =
        Eigen::MatrixXd::Identity(own.rows(), own.rows()) + own * C * own.transpose();
    const Eigen::VectorXd y = dense.y.segment(first, end - first);
    const double distance = std::sqrt(y.dot(spread.llt().solve(y)));
    explained[of_row[static_cast<size_t>(row)]] =
        distance <= chi_quantile(static_cast<int>(own.rows()), kOutlierQuantile);
  }
  return explained;
}

}  // namespace selfcal
