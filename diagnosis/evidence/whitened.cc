#include "diagnosis/evidence/whitened.h"

#include "kinematics/linear_algebra.h"

namespace selfcal {

Nuisance nuisance(const Adjusted& adjusted, Eigen::Index robot, Eigen::Index all) {
  Nuisance nuisance;
  const Prior& prior = adjusted.prior;
  for (size_t c = 0; c < prior.free.size(); ++c)
    if (prior.free[c]) nuisance.columns.push_back(static_cast<int>(c));
  const auto free = static_cast<Eigen::Index>(nuisance.columns.size());
  for (Eigen::Index c = robot; c < all; ++c) nuisance.columns.push_back(static_cast<int>(c));
  nuisance.weight.setZero(static_cast<Eigen::Index>(nuisance.columns.size()));
  nuisance.pull = nuisance.weight;
  for (Eigen::Index i = 0; i < free; ++i) {
    const int c = nuisance.columns[static_cast<size_t>(i)];
    nuisance.weight[i] = 1 / prior.sigma[c];
    nuisance.pull[i] = nuisance.weight[i] * (prior.centre[c] - adjusted.fitted.state.xi[c]);
  }
  return nuisance;
}

Eigen::MatrixXd over_priors(const Eigen::MatrixXd& A, const Eigen::VectorXd& weight) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(A.rows() + A.cols(), A.cols());
  M.topRows(A.rows()) = A;
  M.bottomRows(A.cols()).diagonal() = weight;
  return M;
}

Eigen::VectorXd best_fit(const Whitened& rows, const std::vector<int>& causes,
                         const Eigen::VectorXd& sigma) {
  std::vector<Eigen::Index> moving;
  for (Eigen::Index i = 0; i < sigma.size(); ++i)
    if (sigma[i] > 0) moving.push_back(i);
  const Eigen::Index m = rows.A.rows(), n = rows.A.cols();
  const Eigen::Index k = static_cast<Eigen::Index>(moving.size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m + n + k, n + k);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(m + n + k);
  M.topLeftCorner(m, n) = rows.A;
  M.diagonal(-m).head(n) = rows.weight;
  z.head(m) = rows.y;
  z.segment(m, n) = rows.pull;
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::Index at = moving[static_cast<size_t>(i)];
    M.col(n + i).head(m) = rows.C.col(causes[static_cast<size_t>(at)]);
    M(m + n + i, n + i) = 1 / sigma[at];
  }
  const Eigen::VectorXd found = least_squares(M, z);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + sigma.size());
  x.head(n) = found.head(n);
  for (Eigen::Index i = 0; i < k; ++i) x[n + moving[static_cast<size_t>(i)]] = found[n + i];
  return x;
}

Eigen::VectorXd left_of(const Whitened& every, const Whitened& some, const std::vector<int>& causes,
                        const Eigen::VectorXd& sigma) {
  const Eigen::VectorXd x = best_fit(some, causes, sigma);
  Eigen::VectorXd left = every.y - every.A * x.head(every.A.cols());
  for (size_t i = 0; i < causes.size(); ++i)
    left -= x[every.A.cols() + static_cast<Eigen::Index>(i)] * every.C.col(causes[i]);
  return left;
}

}  // namespace selfcal
