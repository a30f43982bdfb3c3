#include "constraints/planning/design.h"

#include <algorithm>
#include <cmath>

#include "constraints/methods/method.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

// Of the columns' mean square: lets a choice that does not see everything be exchanged away.
constexpr double kRidge = 1e-10;

}  // namespace

Design::Design(const std::vector<Eigen::MatrixXd>& candidates, Objective objective,
               std::vector<int> kinds)
    : objective_(std::move(objective)), in_(candidates.size(), 0), kinds_(std::move(kinds)) {
  expects(!candidates.empty(), "there are candidates");
  if (kinds_.empty()) kinds_.assign(in_.size(), 0);
  expects(kinds_.size() == in_.size(), "every candidate has a kind");
  of_kind_.assign(static_cast<std::size_t>(this->kinds()), {in_.size(), 0});
  for (std::size_t i = 0; i < in_.size(); ++i) {
    Stretch& own = of_kind_[static_cast<std::size_t>(kinds_[i])];
    own.first = std::min(own.first, i);
    own.end = i + 1;
  }
  const Eigen::Index m = candidates.front().cols();
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& w : candidates) {
    expects(w.rows() <= kMostEquations && w.cols() == m,
            "rows of a candidate have the columns of the others");
    at_.push_back(rows);
    k_.push_back(w.rows());
    widest_ = std::max(widest_, w.rows());
    rows += w.rows();
  }
  W_.resize(rows, m);
  for (std::size_t i = 0; i < candidates.size(); ++i) W_.middleRows(at_[i], k_[i]) = candidates[i];
  scale_columns();
  choose({});
}

/// Units of the columns do not change the order of choices, but the rounding.
void Design::scale_columns() {
  const auto count = static_cast<double>(in_.size());
  scale_ = W_.colwise().squaredNorm().transpose() / count;
  if (objective_.prior.rows() > 0) scale_ += objective_.prior.diagonal() / count;
  for (double& each : scale_) each = each > 0 ? std::sqrt(each) : 1;
  const Eigen::VectorXd inverse = scale_.cwiseInverse();
  W_ = W_ * inverse.asDiagonal();
  for (Eigen::MatrixXd* each : {&objective_.prior, &objective_.weight})
    if (each->rows() > 0) *each = (inverse.asDiagonal() * *each * inverse.asDiagonal()).eval();
}

Eigen::MatrixXd Design::rows_of(std::size_t candidate) const {
  return W_.middleRows(at_[candidate], k_[candidate]);
}

void Design::choose(const std::vector<int>& chosen) {
  std::fill(in_.begin(), in_.end(), 0);
  for (const int each : chosen) in_[static_cast<std::size_t>(each)] = 1;
  refresh();
}

std::vector<int> Design::chosen() const {
  std::vector<int> list;
  for (std::size_t i = 0; i < in_.size(); ++i)
    if (in_[i]) list.push_back(static_cast<int>(i));
  return list;
}

Eigen::MatrixXd Design::information(Eigen::Index first, Eigen::Index columns) const {
  const double ridge = objective_.criterion == Criterion::sigma ? 0 : kRidge;
  Eigen::MatrixXd H = ridge * Eigen::MatrixXd::Identity(columns, columns);
  if (objective_.prior.rows() > 0) H += objective_.prior.block(first, first, columns, columns);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < in_.size(); ++i)
    for (Eigen::Index a = 0; in_[i] && a < k_[i]; ++a) rows.push_back(at_[i] + a);
  const Eigen::MatrixXd chosen = W_.middleCols(first, columns)(rows, Eigen::all);
  return H + transposed_product(chosen, chosen);
}

Design::Moments Design::moments(Eigen::Index first, Eigen::Index columns,
                                Eigen::MatrixXd* products) const {
  Moments at;
  at.C = inverse_of_positive(information(first, columns));
  const auto W = W_.middleCols(first, columns);
  Eigen::MatrixXd WC = transposed_product(W.transpose(), at.C);
  at.seen = blocks_of(WC, W);
  if (products) *products = std::move(WC);
  return at;
}

Eigen::MatrixXd Design::blocks_of(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                  const Eigen::Ref<const Eigen::MatrixXd>& B) const {
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(W_.rows(), widest_);
  if (widest_ == 1) {
    blocks.col(0) = A.cwiseProduct(B).rowwise().sum();
    return blocks;
  }
  for (std::size_t i = 0; i < in_.size(); ++i)
    blocks.block(at_[i], 0, k_[i], k_[i]).noalias() =
        A.middleRows(at_[i], k_[i]).lazyProduct(B.middleRows(at_[i], k_[i]).transpose());
  return blocks;
}

void Design::refresh() {
  const Eigen::Index m = W_.cols(), b = objective_.nuisance;
  Eigen::MatrixXd WC;
  all_ = moments(0, m, &WC);
  if (objective_.criterion == Criterion::sigma) {
    trace_ = objective_.weight.cwiseProduct(all_.C).sum();
    spread_ = blocks_of(transposed_product(WC.transpose(), objective_.weight), WC);
  }
  if (objective_.criterion == Criterion::o1) {
    log_determinant_ = 2 * cholesky_root(information(0, m)).diagonal().array().log().sum();
    if (b > 0) {
      nuisance_ = moments(m - b, b, nullptr);
      log_determinant_ -= 2 * cholesky_root(information(m - b, b)).diagonal().array().log().sum();
    }
    // In the parameters' own units.
    log_determinant_ += 2 * scale_.head(interest()).array().log().sum();
  }
}

double Design::merit_of_spectrum(const Eigen::MatrixXd& C) const {
  const Eigen::Index a = interest();
  const Eigen::VectorXd unit = scale_.head(a).cwiseInverse();
  return spectral_merit(
      objective_.criterion,
      symmetric_eigen(unit.asDiagonal() * C.topLeftCorner(a, a) * unit.asDiagonal()).values,
      nullptr);
}

double Design::merit() const {
  if (objective_.criterion == Criterion::sigma) return -trace_;
  if (objective_.criterion == Criterion::o1) return log_determinant_;
  return merit_of_spectrum(all_.C);
}

}  // namespace selfcal
