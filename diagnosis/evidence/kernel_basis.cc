#include "diagnosis/evidence/kernel_basis.h"

#include <algorithm>
#include <cmath>

#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kLeastOfDiagonal = 1e-8;    ///< of the largest variance, that a column is worth
constexpr double kLeastOfVariance = 1e-8;    ///< of the largest direction's
constexpr double kRoundingBelowNone = 1e-6;  ///< of the largest variance, negative by rounding
constexpr Eigen::Index kLowRank = 3;         ///< equations a direction, from which it is worth it

/// The eigenvalues that hold something, and their vectors.
KernelBasis held_directions(const Symmetric& eigen) {
  const Eigen::Index all = eigen.values.size();
  const double most = all > 0 ? eigen.values[all - 1] : 0;
  expects(all == 0 || eigen.values[0] >= -kRoundingBelowNone * std::max(most, 1.0),
          "what rows share is a covariance");
  Eigen::Index first = 0;  // ascending: the small ones come first
  while (first < all && !(eigen.values[first] > kLeastOfVariance * most)) ++first;
  return {eigen.vectors.rightCols(all - first), eigen.values.tail(all - first)};
}

}  // namespace

std::optional<Eigen::MatrixXd> low_rank_root(const Eigen::MatrixXd& K, Eigen::Index most) {
  const Eigen::Index n = K.rows();
  Eigen::VectorXd left = K.diagonal();
  const double largest = n > 0 ? left.maxCoeff() : 0;
  Eigen::MatrixXd F(n, std::min(n, most));
  for (Eigen::Index rank = 0;; ++rank) {
    Eigen::Index pivot = 0;
    const double top = rank < n ? left.maxCoeff(&pivot) : 0;
    expects(n == 0 || left.minCoeff() >= -kRoundingBelowNone * largest,
            "what rows share is a covariance");
    if (!(top > kLeastOfDiagonal * largest)) return F.leftCols(rank).eval();
    if (rank == F.cols()) return std::nullopt;
    F.col(rank) =
        (K.col(pivot) - F.leftCols(rank) * F.row(pivot).head(rank).transpose()) / std::sqrt(top);
    left -= F.col(rank).cwiseAbs2();
    left[pivot] = 0;
  }
}

KernelBasis basis_of_root(const NoiseBlocks& noise, Eigen::MatrixXd F) {
  noise.whiten(F);
  if (F.cols() >= F.rows())
    return held_directions(symmetric_eigen(transposed_product(F.transpose(), F.transpose())));
  KernelBasis basis = held_directions(symmetric_eigen(transposed_product(F, F)));
  basis.W = transposed_product(F.transpose(), basis.W) *
            basis.variance.cwiseSqrt().cwiseInverse().asDiagonal();
  return basis;
}

KernelBasis basis_of_kernel(const NoiseBlocks& noise, Eigen::MatrixXd K) {
  if (auto root = low_rank_root(K, K.rows() / kLowRank))
    return basis_of_root(noise, *std::move(root));
  noise.whiten(K);
  K.transposeInPlace();
  noise.whiten(K);
  return held_directions(symmetric_eigen(K));
}

}  // namespace selfcal
