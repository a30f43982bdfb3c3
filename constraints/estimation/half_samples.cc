// Balanced half-samples (McCarthy 1969) of rows in their order. With [R_h | z_h] the rows of half h
// at the fitted parameters and Lambda, pull the precision of the priors and what they ask for,
//   s_h = C_h (R_h^T z_h + pull),   C_h = (R_h^T R_h + Lambda)^-1,   difference (s_1 - s_2) / 2,
// whose square is expected to be, where the rows err apart and the truth is as the priors say,
//   ((C_2 - C_1) Lambda (C_2 - C_1) + sum_h (C_h - C_h Lambda C_h)) / 4.
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

/// What one half of the rows and the priors give: columns() entries, and their posterior.
struct HalfFit {
  Eigen::VectorXd step;
  Eigen::MatrixXd C;
};

HalfFit fit_of(const Equations& equations, const Adjusted& adjusted, const Weighting& weighting) {
  const Eigen::MatrixXd R = equations.linearise(adjusted.fitted.state, weighting).R;
  const std::vector<int> columns = free_columns(equations, adjusted.prior);
  const Eigen::MatrixXd A =
      triangle_with_priors(equations, adjusted.prior, columns, R, adjusted.fitted.state.xi, true);
  const auto n = static_cast<Eigen::Index>(columns.size());
  const Eigen::MatrixXd inverse = inverse_of_triangle(A.topLeftCorner(n, n));
  HalfFit fit{Eigen::VectorXd::Zero(equations.columns()),
              Eigen::MatrixXd::Zero(equations.columns(), equations.columns())};
  fit.step(columns) = inverse * A.col(n).head(n);
  fit.C(columns, columns) = inverse * inverse.transpose();
  return fit;
}

}  // namespace

HalfSamples half_samples(const Equations& equations, const Adjusted& adjusted) {
  const std::vector<int> stretch = stretches(equations);
  const Noise& noise = adjusted.fitted.noise;
  const Eigen::Index n = equations.columns();
  const Eigen::VectorXd lambda = prior_precision(equations, adjusted.prior);
  HalfSamples result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (const int other : kSplits) {
    Weighting first{noise.used, noise.outlier}, second = first;
    for (size_t row = 0; row < stretch.size(); ++row)
      (stretch[row] == 0 || stretch[row] == other ? second : first).outlier[row] = 1;
    const HalfFit a = fit_of(equations, adjusted, first), b = fit_of(equations, adjusted, second);
    const Eigen::VectorXd difference = (a.step - b.step) / 2;
    const Eigen::MatrixXd shrunk = b.C - a.C;
    result.seen += difference * difference.transpose() / kSplits.size();
    result.expected += (shrunk * lambda.asDiagonal() * shrunk + a.C -
                        a.C * lambda.asDiagonal() * a.C + b.C - b.C * lambda.asDiagonal() * b.C) /
                       (4.0 * kSplits.size());
  }
  return result;
}

}  // namespace selfcal
