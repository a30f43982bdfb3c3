#include "diagnosis/evidence/evidence_rows.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr Eigen::Index kAtATime = 512;  ///< products that are weighted at a time

}  // namespace

Eigen::VectorXd DiscrepancyCovariance::hidden() const {
  if (!kernel) return {};
  const Eigen::ArrayXd over_noise = kappa * kappa * kernel->variance.array();
  return over_noise / (1 + over_noise);
}

double DiscrepancyCovariance::log_volume() const {
  double sum =
      blocks->log_volume() + static_cast<double>(blocks->equations()) / 2 * std::log(noise);
  if (kernel) sum += (kappa * kappa * kernel->variance.array()).log1p().sum() / 2;
  return sum;
}

Eigen::VectorXd DiscrepancyCovariance::coloured(const Eigen::VectorXd& normal) const {
  if (kernel) return cholesky_root(matrix()).triangularView<Eigen::Lower>() * normal;
  Eigen::MatrixXd y = std::sqrt(noise) * normal;
  blocks->colour(y);
  return y;
}

Eigen::MatrixXd DiscrepancyCovariance::matrix() const {
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(blocks->equations(), blocks->equations());
  if (kernel) {
    const Eigen::MatrixXd Wt = kernel->W.transpose();
    S += transposed_product(kappa * kappa * kernel->variance.asDiagonal() * Wt, Wt);
  }
  blocks->colour(S);
  S.transposeInPlace();
  blocks->colour(S);
  return noise * S;
}

GroupProducts::GroupProducts(const Groups& groups) {
  for (const std::vector<int>& group : groups) {
    at_.push_back(pairs_.size());
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) pairs_.push_back({group[i], group[j]});
  }
  size_ = pairs_.size();
}

void GroupProducts::add(const Eigen::MatrixXd& X, double factor, std::vector<double>& to) const {
  for (std::size_t i = 0; i < size_; ++i)
    to[i] += factor * X.col(pairs_[i].first).dot(X.col(pairs_[i].second));
}

Eigen::MatrixXd GroupProducts::weighted(const Eigen::MatrixXd& X,
                                        const Eigen::MatrixXd& weights) const {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(size_), weights.cols());
  Eigen::MatrixXd part;
  for (Eigen::Index first = 0; first < all.rows(); first += kAtATime) {
    const Eigen::Index count = std::min(kAtATime, all.rows() - first);
    part.resize(X.rows(), count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Pair& pair = pairs_[static_cast<std::size_t>(first + i)];
      part.col(i) = X.col(pair.first).cwiseProduct(X.col(pair.second));
    }
    all.middleRows(first, count) = transposed_product(part, weights);
  }
  return all;
}

EvidenceRows::EvidenceRows(std::shared_ptr<const Whitened> rows, const Groups& groups)
    : rows_(std::move(rows)), products_(groups) {
  OrthogonalColumns qr = orthogonal_columns(over_priors(rows_->A, rows_->weight));
  A_ = qr.Q.topRows(rows_->A.rows());
  B_ = qr.Q.bottomRows(rows_->A.cols());
  log_volume_ = qr.log_volume;
}

Eigen::VectorXd EvidenceRows::left_of(const Eigen::VectorXd& y, const std::vector<int>& causes,
                                      const Eigen::VectorXd& sigma) const {
  const Eigen::VectorXd Ay = A_.transpose() * y;
  const Eigen::VectorXd left = y - A_ * Ay;
  const Eigen::MatrixXd c = rows_->C(Eigen::all, causes) * sigma.asDiagonal();
  const Eigen::MatrixXd Ac = A_.transpose() * c;
  // c'beyond is the square beyond geometry and priors: A over B is orthonormal.
  const Eigen::MatrixXd beyond = c - A_ * Ac;
  const Eigen::MatrixXd L = cholesky_root(Eigen::MatrixXd::Identity(c.cols(), c.cols()) +
                                          Eigen::MatrixXd(c.transpose() * beyond));
  const Eigen::VectorXd v =
      solve_lower_transposed(L, solve_lower(L, Eigen::VectorXd(c.transpose() * left)));
  return left - beyond * v;
}

EvidenceRows::OverNoise EvidenceRows::over(std::shared_ptr<const NoiseBlocks> blocks) const {
  OverNoise over;
  Eigen::MatrixXd LA = A_;
  blocks->whiten(LA);
  over.AA = transposed_product(LA, LA);
  blocks->whiten_transposed(LA);
  over.PA = std::move(LA);
  over.AC = transposed_product(over.PA, rows_->C);
  Eigen::MatrixXd LC = rows_->C;
  blocks->whiten(LC);
  over.products.assign(products_.size(), 0);
  products_.add(LC, 1, over.products);
  over.blocks = std::move(blocks);
  return over;
}

EvidenceRows::OverKernel EvidenceRows::over(const NoiseBlocks& blocks,
                                            std::shared_ptr<const KernelBasis> kernel) const {
  OverKernel over;
  Eigen::MatrixXd U = kernel->W;
  blocks.whiten_transposed(U);
  over.UA = transposed_product(U, A_);
  over.UC = transposed_product(U, rows_->C);
  over.kernel = std::move(kernel);
  return over;
}

void StructuredRows::take(const DiscrepancyCovariance& structure) {
  if (!noise || noise->blocks != structure.blocks)
    noise = std::make_shared<const EvidenceRows::OverNoise>(rows->over(structure.blocks));
  if (!structure.kernel)
    kernel = nullptr;
  else if (!kernel || kernel->kernel != structure.kernel)
    kernel = std::make_shared<const EvidenceRows::OverKernel>(
        rows->over(*structure.blocks, structure.kernel));
  hidden = structure.hidden();
  AA = noise->AA;
  if (kernel) AA -= transposed_product(hidden.asDiagonal() * kernel->UA, kernel->UA);
}

Eigen::MatrixXd StructuredRows::inverse_times(Eigen::MatrixXd X) const {
  noise->blocks->whiten(X);
  if (kernel) {
    const Eigen::MatrixXd& W = kernel->kernel->W;
    X -= product(W, hidden.asDiagonal() * transposed_product(W, X));
  }
  noise->blocks->whiten_transposed(X);
  return X;
}

void StructuredRows::whiten(Eigen::MatrixXd& X) const {
  noise->blocks->whiten(X);
  if (!kernel) return;
  // (I - W h W')^(1/2) = I - W (1 - (1 - h)^(1/2)) W', W orthonormal.
  const Eigen::MatrixXd& W = kernel->kernel->W;
  const Eigen::VectorXd part = 1 - (1 - hidden.array()).sqrt();
  X -= product(W, part.asDiagonal() * transposed_product(W, X));
}

Eigen::MatrixXd StructuredRows::AC() const {
  if (!kernel) return noise->AC;
  return noise->AC - transposed_product(hidden.asDiagonal() * kernel->UA, kernel->UC);
}

Eigen::MatrixXd StructuredRows::AC(const std::vector<int>& columns) const {
  const Eigen::MatrixXd AC = noise->AC(Eigen::all, columns);
  if (!kernel) return AC;
  return AC - transposed_product(hidden.asDiagonal() * kernel->UA, kernel->UC(Eigen::all, columns));
}

std::vector<double> StructuredRows::products() const {
  std::vector<double> all = noise->products;
  if (!kernel) return all;
  const Eigen::MatrixXd less = rows->products().weighted(kernel->UC, hidden);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] -= less(static_cast<Eigen::Index>(i), 0);
  return all;
}

ObservedRows::ObservedRows(const EvidenceRows& rows, Eigen::MatrixXd Y, bool with_causes)
    : rows_(rows), Y_(std::move(Y)), with_causes_(with_causes) {}

void ObservedRows::look_over(const StructuredRows& structure) {
  if (structure.noise != noise_) {
    noise_ = structure.noise;
    white_ = Y_;
    noise_->blocks->whiten(white_);
    squares_ = white_.colwise().squaredNorm().transpose();
    AY_ = transposed_product(noise_->PA, Y_);
    if (with_causes_) {
      Eigen::MatrixXd PY = white_;
      noise_->blocks->whiten_transposed(PY);
      CY_ = transposed_product(rows_.rows().C, PY);
    }
  }
  if (structure.kernel == kernel_) return;
  kernel_ = structure.kernel;
  if (kernel_) UY_ = transposed_product(kernel_->kernel->W, white_);
}

Eigen::MatrixXd ObservedRows::AY(const StructuredRows& structure) const {
  if (!kernel_) return AY_;
  return AY_ - transposed_product(kernel_->UA, structure.hidden.asDiagonal() * UY_);
}

Eigen::VectorXd ObservedRows::squares(const StructuredRows& structure) const {
  if (!kernel_) return squares_;
  return squares_ - (structure.hidden.asDiagonal() * UY_.cwiseAbs2()).colwise().sum().transpose();
}

}  // namespace selfcal
