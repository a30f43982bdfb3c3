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

Eigen::VectorXd left_of(const Whitened& every, const Whitened& some, const std::vector<int>& causes,
                        const Eigen::VectorXd& sigma) {
  std::vector<int> moving;
  std::vector<double> prior;
  for (size_t i = 0; i < causes.size(); ++i)
    if (const double each = sigma[static_cast<Eigen::Index>(i)]; each > 0) {
      moving.push_back(causes[i]);
      prior.push_back(1 / each);
    }
  const Eigen::Index n = some.A.cols(), k = static_cast<Eigen::Index>(moving.size());
  Eigen::MatrixXd all(some.A.rows(), n + k);
  all << some.A, some.C(Eigen::all, moving);
  Eigen::VectorXd weight(n + k);
  weight << some.weight, Eigen::Map<const Eigen::VectorXd>(prior.data(), k);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(all.rows() + n + k);
  z.head(all.rows()) = some.y;
  z.segment(all.rows(), n) = some.pull;
  const Eigen::VectorXd x = least_squares(over_priors(all, weight), z);
  return every.y - every.A * x.head(n) - every.C(Eigen::all, moving) * x.tail(k);
}

}  // namespace selfcal
