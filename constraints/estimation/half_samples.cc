// Balanced half-samples (McCarthy 1969) of rows in their order. With [R_h | z_h] the rows of half h
// at the fitted parameters and Lambda, pull the precision of the priors and what they ask for,
//   s_h = (R_h^T R_h + Lambda)^-1 (R_h^T z_h + pull),   difference (s_1 - s_2) / 2.
// Rows soon after each other share what the model lacks (a region of the cell, a temperature, a
// series); in a stretch they do so all together, and the halves show by how much.
#include "constraints/estimation/half_samples.h"

#include <array>
#include <vector>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kStretches = 4;
/// The stretches that make the first half with the first one.
constexpr std::array kSplits = {1, 2, 3};

/// By row of the data set, the stretch of its set's rows that it is in; -1 of other rows.
std::vector<int> stretches(const Equations& equations) {
  const Observations& rows = equations.data().rows;
  std::vector<int> of_row(static_cast<size_t>(rows.rows()), -1);
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    std::vector<char> here(of_row.size(), 0);
    for (const SetPlan::Item& item : equations.plan(s).items)
      here[static_cast<size_t>(item.row)] = 1;
    const auto count = static_cast<int>(equations.plan(s).items.size());
    int k = 0;
    for (size_t row = 0; row < here.size(); ++row)
      if (here[row]) of_row[row] = kStretches * k++ / count;
  }
  return of_row;
}

/// The step that the rows of `weighting` and the priors ask for; columns() entries.
Eigen::VectorXd step_of(const Equations& equations, const Adjusted& adjusted,
                        const Weighting& weighting) {
  const Eigen::VectorXd& xi = adjusted.fitted.state.xi;
  const Eigen::MatrixXd R = equations.linearise(adjusted.fitted.state, weighting).R;
  const std::vector<int> columns = free_columns(equations, adjusted.prior);
  const auto n = static_cast<Eigen::Index>(columns.size()), K = R.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K + n, n + 1);
  A.topRows(K) << R(Eigen::all, columns), R.rightCols(1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int c = columns[static_cast<size_t>(i)];
    A(K + i, i) = prior_weight(equations, adjusted.prior, c);
    if (c < equations.robot_columns())
      A(K + i, n) = A(K + i, i) * (adjusted.prior.centre[c] - xi[c]);
  }
  triangularise(A);
  const Eigen::VectorXd of_free = inverse_of_triangle(A.topLeftCorner(n, n)) * A.col(n).head(n);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(equations.columns());
  for (Eigen::Index i = 0; i < n; ++i) step[columns[static_cast<size_t>(i)]] = of_free[i];
  return step;
}

}  // namespace

Eigen::MatrixXd half_sample_differences(const Equations& equations, const Adjusted& adjusted) {
  const std::vector<int> stretch = stretches(equations);
  const Noise& noise = adjusted.fitted.noise;
  Eigen::MatrixXd differences(kSplits.size(), equations.columns());
  for (size_t k = 0; k < kSplits.size(); ++k) {
    Weighting first{noise.used, noise.outlier}, second = first;
    for (size_t row = 0; row < stretch.size(); ++row) {
      const bool in_first = stretch[row] == 0 || stretch[row] == kSplits[k];
      (in_first ? second : first).outlier[row] = 1;
    }
    differences.row(static_cast<Eigen::Index>(k)) =
        (step_of(equations, adjusted, first) - step_of(equations, adjusted, second)).transpose() /
        2;
  }
  return differences;
}

}  // namespace selfcal
