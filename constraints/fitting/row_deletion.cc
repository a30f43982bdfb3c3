#include "constraints/fitting/row_deletion.h"

#include <cmath>
#include <numeric>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kNothingLeft = 1e-13;  ///< of a column, left where others explain it
constexpr double kMet = 1e-12;  ///< of an equation's freedom, left where its row fits itself

}  // namespace

std::vector<RowDeletion::OwnPart> RowDeletion::own_parts(const Eigen::MatrixXd& W,
                                                         const std::vector<int>& columns) {
  std::vector<std::size_t> root(columns.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t c) {
    while (root[c] != c) c = root[c] = root[root[c]];
    return c;
  };
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> of_equation(static_cast<std::size_t>(W.rows()), none);
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (Eigen::Index i = 0; i < W.rows(); ++i) {
      if (W(i, columns[c]) == 0) continue;
      std::size_t& other = of_equation[static_cast<std::size_t>(i)];
      if (other == none)
        other = c;
      else
        root[root_of(c)] = root_of(other);
    }
  std::vector<OwnPart> parts;
  std::vector<std::size_t> part(columns.size(), none);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::size_t& of = part[root_of(c)];
    if (of == none) {
      of = parts.size();
      parts.emplace_back();
    }
    parts[of].columns.push_back(columns[c]);
  }
  for (std::size_t i = 0; i < of_equation.size(); ++i)
    if (of_equation[i] != none)
      parts[part[root_of(of_equation[i])]].equations.push_back(static_cast<Eigen::Index>(i));
  return parts;
}

RowDeletion::RowDeletion(const Equations& equations, const State& state, const Noise& noise,
                         const Prior& prior)
    : equations_(equations) {
  const DenseEquations dense = equations.dense(state, noise.used, noise.outlier);
  row_ = dense.row;
  take_quantities();
  std::vector<int> robot, own;
  for (const int c : free_columns(equations, prior))
    (c < equations.robot_columns() ? robot : own).push_back(c);
  for (int c = equations.columns(); c < dense.W.cols(); ++c) own.push_back(c);
  const auto rows = dense.y.size(), n = static_cast<Eigen::Index>(robot.size());
  // [robot | y] of the equations, of the robot's priors, of the others' as these take part.
  Eigen::MatrixXd A =
      Eigen::MatrixXd::Zero(rows + n + static_cast<Eigen::Index>(own.size()), n + 1);
  A.col(n).head(rows) = dense.y;
  for (Eigen::Index i = 0; const int c : robot) {
    A.col(i).head(rows) = dense.W.col(c);
    A(rows + i, i) = prior_weight(equations, prior, c);
    A(rows + i, n) = A(rows + i, i) * (prior.centre[c] - state.xi[c]);
    ++i;
  }
  const Eigen::VectorXd length = A.leftCols(n).colwise().norm();
  Eigen::Index at = rows + n;
  part_.assign(static_cast<std::size_t>(rows), -1);
  Q_own_.resize(static_cast<std::size_t>(rows));
  for (OwnPart& part : own_parts(dense.W, own)) {
    put_beyond(prior, dense.W, part, at, A);
    at += static_cast<Eigen::Index>(part.columns.size());
    for (const Eigen::Index i : part.equations)
      part_[static_cast<std::size_t>(i)] = static_cast<int>(parts_.size());
    parts_.push_back(std::move(part.equations));
  }
  Eigen::MatrixXd Q(A.rows(), 0);
  if (n > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
        A.leftCols(n) * length.cwiseMax(1e-300).cwiseInverse().asDiagonal());
    const Eigen::Index rank = (qr.matrixQR().diagonal().cwiseAbs().array() > kNothingLeft).count();
    Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), rank);
  }
  left_ = (A.col(n) - Q * (Q.transpose() * A.col(n))).head(rows);
  Q_ = Q.topRows(rows).transpose();
  freedom_.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) freedom_[i] = product(i, i);
}

std::vector<Deletion> RowDeletion::deletions() const {
  std::vector<std::vector<Eigen::Index>> of_row(equations_.data().rows.set.size());
  for (Eigen::Index i = 0; i < left_.size(); ++i)
    if (const int row = row_[static_cast<std::size_t>(i)]; row >= 0)
      of_row[static_cast<std::size_t>(row)].push_back(i);
  std::vector<Deletion> list;
  for (int row = 0; row < static_cast<int>(of_row.size()); ++row) {
    std::vector<Eigen::Index>& own = of_row[static_cast<std::size_t>(row)];
    if (own.empty()) continue;
    const auto count = static_cast<Eigen::Index>(own.size());
    Eigen::MatrixXd part(count, count);
    for (Eigen::Index b = 0; b < count; ++b)
      for (Eigen::Index a = 0; a < count; ++a)
        part(a, b) = product(own[static_cast<std::size_t>(a)], own[static_cast<std::size_t>(b)]);
    Deletion each{row, equations_.data().rows.set[static_cast<std::size_t>(row)], std::move(own),
                  std::move(part), 0};
    const Eigen::VectorXd left = left_(each.equations);
    each.drop = left.dot(least_squares(each.part, left));
    list.push_back(std::move(each));
  }
  return list;
}

RowDeletion::Left RowDeletion::left_without(const Deletion& of) const {
  const Eigen::MatrixXd own = columns(of), share = least_squares_of_all(of.part, own.transpose());
  return {left_ - share.transpose() * left_(of.equations),
          freedom_ - (own.array() * share.transpose().array()).rowwise().sum().matrix()};
}

void RowDeletion::take_away(const Deletion& of) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(of.part);
  const Eigen::VectorXd part = eigen.eigenvalues();
  const Eigen::VectorXd left = eigen.eigenvectors().transpose() * left_(of.equations);
  const Eigen::MatrixXd of_part = columns(of) * eigen.eigenvectors();
  for (Eigen::Index k = 0; k < part.size(); ++k) {
    if (part[k] < kMet) continue;
    taken_.emplace_back(of_part.col(k) / std::sqrt(part[k]));
    left_ -= taken_.back() * (left[k] / std::sqrt(part[k]));
    freedom_ -= taken_.back().cwiseAbs2();
  }
  for (const Eigen::Index i : of.equations) row_[static_cast<std::size_t>(i)] = -1;
}

void RowDeletion::take_quantities() {
  std::vector<std::vector<Quantity>> of_set;
  for (const Set& set : equations_.data().sets) of_set.push_back(set.method->equations());
  std::size_t first = 0;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] != row_[first]) first = i;
    const int set =
        row_[i] < 0 ? -1 : equations_.data().rows.set[static_cast<std::size_t>(row_[i])];
    set_.push_back(set);
    quantity_.push_back(set < 0 ? Quantity::other
                                : of_set[static_cast<std::size_t>(set)][i - first]);
  }
}

void RowDeletion::put_beyond(const Prior& prior, const Eigen::MatrixXd& W, const OwnPart& part,
                             Eigen::Index at, Eigen::MatrixXd& A) {
  const auto count = static_cast<Eigen::Index>(part.equations.size()),
             width = static_cast<Eigen::Index>(part.columns.size());
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(count + width, width);
  std::vector<Eigen::Index> rows = part.equations;
  for (Eigen::Index j = 0; j < width; ++j) {
    const int c = part.columns[static_cast<std::size_t>(j)];
    own.col(j).head(count) = W.col(c)(part.equations);
    if (c < equations_.columns()) own(count + j, j) = prior_weight(equations_, prior, c);
    rows.push_back(at + j);
  }
  const Eigen::MatrixXd Q = orthogonal_columns(own).Q;
  const Eigen::MatrixXd of_others = A(rows, Eigen::all);
  A(rows, Eigen::all) = of_others - Q * (Q.transpose() * of_others);
  for (Eigen::Index i = 0; i < count; ++i)
    Q_own_[static_cast<std::size_t>(part.equations[static_cast<std::size_t>(i)])] =
        Q.row(i).transpose();
}

double RowDeletion::own_product(Eigen::Index a, Eigen::Index b) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return part_[i] < 0 || part_[i] != part_[j] ? 0 : Q_own_[i].dot(Q_own_[j]);
}

double RowDeletion::product(Eigen::Index a, Eigen::Index b) const {
  double sum = (a == b ? 1 : 0) - Q_.col(a).dot(Q_.col(b)) - own_product(a, b);
  for (const Eigen::VectorXd& each : taken_) sum -= each[a] * each[b];
  return sum;
}

Eigen::MatrixXd RowDeletion::columns(const Deletion& of) const {
  Eigen::MatrixXd list = -Q_.transpose() * Q_(Eigen::all, of.equations);
  for (Eigen::Index k = 0; k < list.cols(); ++k) {
    const Eigen::Index one = of.equations[static_cast<std::size_t>(k)];
    list(one, k) += 1;
    if (const int part = part_[static_cast<std::size_t>(one)]; part >= 0)
      for (const Eigen::Index i : parts_[static_cast<std::size_t>(part)])
        list(i, k) -= own_product(i, one);
    for (const Eigen::VectorXd& each : taken_) list.col(k) -= each * each[one];
  }
  return list;
}

}  // namespace selfcal
