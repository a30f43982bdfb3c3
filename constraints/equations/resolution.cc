// A reading rounded to a step errs by step / sqrt(12); an equation by that times what the joint's
// own variable moves it, W of its zero, the joints apart from each other.
#include "constraints/equations/resolution.h"

#include <cmath>

namespace selfcal {
namespace {

constexpr int kMostAveraged = 300;  ///< that the mean is taken over
/// Of the variance of what is left: a joint's rounding may seem to make so much of it by chance.
constexpr double kMostOfRounding = 1.5;

}  // namespace

Eigen::VectorXd reading_steps(const Eigen::MatrixXd& q) {
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(q.cols());
  for (Eigen::Index j = 0; j < q.cols(); ++j)
    for (double power = 1e-2; power > 0.9e-9 && steps[j] == 0; power /= 10)
      for (const double step : {5 * power, 2 * power, power}) {
        const Eigen::ArrayXd multiple = q.col(j).array() / step;
        if (((multiple - multiple.round()).abs() > 1e-3).any()) continue;
        steps[j] = step;
        break;
      }
  return steps;
}

Eigen::VectorXd credible_steps(const Eigen::MatrixXd& q, const Eigen::MatrixXd& by_joint) {
  Eigen::VectorXd steps = reading_steps(q);
  const auto equations = static_cast<double>(by_joint.rows());
  for (Eigen::Index j = 0; j < steps.size(); ++j) {
    const bool stands = q.rows() == 0 || q.col(j).minCoeff() == q.col(j).maxCoeff();
    const double moved = by_joint.col(j).squaredNorm() * std::pow(steps[j], 2) / 12;
    if (stands || moved > kMostOfRounding * equations) steps[j] = 0;
  }
  return steps;
}

std::vector<double> resolution_shares(const Equations& equations, const State& state,
                                      const std::vector<Scale>& scale,
                                      const std::vector<char>& outlier) {
  const Observations& rows = equations.data().rows;
  std::vector<double> squares(equations.data().sets.size(), 0), count(squares.size(), 0);
  if (reading_steps(rows.q).norm() == 0) return squares;
  std::vector<char> left_out = outlier;
  const int each = 1 + rows.rows() / kMostAveraged;
  for (int row = 0; row < rows.rows(); ++row)
    if (row % each != 0) left_out[static_cast<size_t>(row)] = 1;
  const DenseEquations dense = equations.dense(state, scale, left_out);
  Eigen::MatrixXd by_joint = Eigen::MatrixXd::Zero(dense.W.rows(), rows.q.cols());
  for (Eigen::Index j = 0; j < by_joint.cols(); ++j)
    if (const int zero = equations.robot().variable_parameter(static_cast<int>(j)); zero >= 0)
      by_joint.col(j) = dense.W.col(zero);
  const Eigen::VectorXd steps = credible_steps(rows.q, by_joint);
  for (Eigen::Index i = 0; i < dense.W.rows(); ++i) {
    if (dense.row[static_cast<size_t>(i)] < 0) continue;
    const auto set = static_cast<size_t>(rows.set[dense.row[static_cast<size_t>(i)]]);
    count[set] += 1;
    squares[set] += (by_joint.row(i).transpose().cwiseProduct(steps)).squaredNorm() / 12;
  }
  for (size_t s = 0; s < squares.size(); ++s)
    if (count[s] > 0) squares[s] /= count[s];
  return squares;
}

}  // namespace selfcal
