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

Predicted predicted(const DataSet& data, const Equations& fit_equations, const Judged& after,
                    const std::vector<char>& asked) {
  std::vector<char> others(static_cast<size_t>(data.rows.rows()), 1);
  std::ptrdiff_t taken = 0;
  for (std::size_t i = 0; i < after.check.size() && taken < kMost; ++i) {
    const RowResidual& r = after.check[i];
    if (!asked[i] || !is_predicted(fit_equations, after, r.set)) continue;
    others[static_cast<size_t>(r.row)] = 0;
    ++taken;
  }
  if (taken == 0) return {};
  const Equations check(fit_equations.robot(), data, Use::check);
  DenseEquations dense = check.dense(after.state, after.check_scale, others);
  std::vector<int> of_rows;
  for (std::size_t e = 0; e < dense.row.size(); ++e)
    if (dense.row[e] >= 0) of_rows.push_back(static_cast<int>(e));
  Predicted out{
      dense.y(of_rows), in_columns_of(fit_equations, check, dense.W(of_rows, Eigen::all)), {}};
  for (const int e : of_rows) out.row.push_back(dense.row[static_cast<std::size_t>(e)]);
  return out;
}

double squared_distance(const Eigen::VectorXd& y, const Eigen::MatrixXd& W,
                        const Eigen::MatrixXd& C) {
  const Eigen::MatrixXd spread =
      Eigen::MatrixXd::Identity(W.rows(), W.rows()) + W * C * W.transpose();
  return y.dot(spread.llt().solve(y));
}

std::vector<char> foreseen(const DataSet& data, const Equations& fit_equations,
                           const Eigen::MatrixXd& C, const Judged& after) {
  std::vector<char> beyond, explained(after.check.size(), 0);
  std::vector<std::size_t> of_row(static_cast<std::size_t>(data.rows.rows()));
  for (std::size_t i = 0; i < after.check.size(); ++i) {
    beyond.push_back(is_outlier(after.check[i], after));
    of_row[static_cast<std::size_t>(after.check[i].row)] = i;
  }
  const Predicted rows = predicted(data, fit_equations, after, beyond);
  for (Eigen::Index first = 0, end = 0; first < rows.W.rows(); first = end) {
    const int row = rows.row[static_cast<std::size_t>(first)];
    while (end < rows.W.rows() && rows.row[static_cast<std::size_t>(end)] == row) ++end;
    const double squared = squared_distance(rows.y.segment(first, end - first),
                                            rows.W.middleRows(first, end - first), C);
    explained[of_row[static_cast<std::size_t>(row)]] =
        std::sqrt(squared) <= chi_quantile(static_cast<int>(end - first), kOutlierQuantile);
  }
  return explained;
}

}  // namespace selfcal
