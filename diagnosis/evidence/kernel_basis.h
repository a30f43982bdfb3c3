// A covariance of many equations by the few directions that hold nearly all of it, as a noise S =
// L L' sees them: L^-1 K L^-T = W diag(variance) W'. One basis serves every size of K over S.
#pragma once

#include <Eigen/Dense>
#include <optional>

#include "diagnosis/evidence/noise_blocks.h"

namespace selfcal {

struct KernelBasis {
  Eigen::MatrixXd W;         ///< equations x directions, orthonormal
  Eigen::VectorXd variance;  ///< of each; those beside them have none
};

/// F with F F' = `K` (positive semidefinite) but for rounding, as few columns as that takes;
/// nothing where these are more than `most`. Cholesky with pivots (Higham, Accuracy and Stability
/// of Numerical Algorithms, section 10.3).
std::optional<Eigen::MatrixXd> low_rank_root(const Eigen::MatrixXd& K, Eigen::Index most);

/// Of K = F F'.
KernelBasis basis_of_root(const NoiseBlocks& noise, Eigen::MatrixXd F);
/// Of `K` itself.
KernelBasis basis_of_kernel(const NoiseBlocks& noise, Eigen::MatrixXd K);

}  // namespace selfcal
