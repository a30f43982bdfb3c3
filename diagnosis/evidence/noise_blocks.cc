#include "diagnosis/evidence/noise_blocks.h"

#include <cmath>

#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kMissed = 1e-6;  ///< of a variance, that its root may miss

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd root = cholesky_root(covariance);
  const Eigen::VectorXd missing = root.rowwise().squaredNorm() - covariance.diagonal();
  expects((missing.array().abs() <= kMissed * covariance.diagonal().array()).all(),
          "what rows share is a covariance");
  return root;
}

}  // namespace

NoiseBlocks::NoiseBlocks(std::vector<std::vector<int>> blocks,
                         const std::function<double(int, int)>& covariance) {
  for (const std::vector<int>& each : blocks) equations_ += static_cast<Eigen::Index>(each.size());
  alone_.setOnes(equations_);
  for (std::vector<int>& each : blocks) {
    const auto n = static_cast<Eigen::Index>(each.size());
    Eigen::MatrixXd K(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) K(i, j) = K(j, i) = covariance(each[i], each[j]);
    Eigen::MatrixXd root = root_of(K);
    log_volume_ += root.diagonal().array().log().sum();
    if (n == 1)
      alone_[each.front()] = root(0, 0);
    else
      parts_.push_back({std::move(each), root, root.diagonal().cwiseInverse()});
  }
  inverse_alone_ = alone_.cwiseInverse();
}

void NoiseBlocks::whiten(Eigen::MatrixXd& X) const {
  for (auto column : X.colwise()) {
    column.array() *= inverse_alone_.array();
    for (const Part& part : parts_) {
      const auto n = static_cast<Eigen::Index>(part.equations.size());
      for (Eigen::Index i = 0; i < n; ++i) {
        double sum = column[part.equations[i]];
        for (Eigen::Index j = 0; j < i; ++j) sum -= part.root(i, j) * column[part.equations[j]];
        column[part.equations[i]] = sum * part.inverse[i];
      }
    }
  }
}

void NoiseBlocks::whiten_transposed(Eigen::MatrixXd& X) const {
  for (auto column : X.colwise()) {
    column.array() *= inverse_alone_.array();
    for (const Part& part : parts_) {
      const auto n = static_cast<Eigen::Index>(part.equations.size());
      for (Eigen::Index i = n - 1; i >= 0; --i) {
        double sum = column[part.equations[i]];
        for (Eigen::Index j = i + 1; j < n; ++j) sum -= part.root(j, i) * column[part.equations[j]];
        column[part.equations[i]] = sum * part.inverse[i];
      }
    }
  }
}

void NoiseBlocks::colour(Eigen::MatrixXd& X) const {
  for (auto column : X.colwise()) {
    column.array() *= alone_.array();
    for (const Part& part : parts_)
      for (auto i = static_cast<Eigen::Index>(part.equations.size()) - 1; i >= 0; --i) {
        double sum = 0;
        for (Eigen::Index j = 0; j <= i; ++j) sum += part.root(i, j) * column[part.equations[j]];
        column[part.equations[i]] = sum;
      }
  }
}

}  // namespace selfcal
