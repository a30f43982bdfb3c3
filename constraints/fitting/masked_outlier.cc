#include "constraints/fitting/masked_outlier.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kMaskedByChance = 1e-6;
constexpr double kLeastOfNoise = 1e-9;            ///< that rows which fit exactly have: rounding
constexpr Eigen::Index kMostEquations = 3000;     ///< with more, none bends the fit alone
constexpr Eigen::Index kMostEntries = 1'000'000;  ///< of the equations held at once
constexpr std::size_t kMostTried = 20;            ///< those whose absence makes most difference
constexpr double kNothingLeft = 1e-13;            ///< of a column, left where others explain it
constexpr double kMet = 1e-12;  ///< of an equation's freedom, left where its row fits itself
constexpr double kSheet = 4;    ///< freedoms that a data sheet's noise is worth

/// What a row's absence does to the least squares.
struct Deletion {
  int row = 0, set = 0;
  std::vector<Eigen::Index> equations;
  Eigen::MatrixXd part;  ///< I - H of its equations
  double drop = 0;       ///< of the sum of squares
};

/// A row's drop over what the others say that it should be, and that a good row's is as large.
struct Standing {
  double ratio = 0, chance = 1;
};

/// Whether the least squares can be held whole.
bool are_few(const Equations& equations, const State& state) {
  Eigen::Index count = 0, columns = equations.columns();
  for (std::size_t s = 0; s < equations.data().sets.size(); ++s) {
    const Method& method = *equations.data().sets[s].method;
    count += static_cast<Eigen::Index>(equations.plan(static_cast<int>(s)).items.size() *
                                       method.equations().size());
    columns += state.groups[s].cols() * method.group_freedom();
  }
  return count <= kMostEquations && count * columns <= kMostEntries;
}

/// Own unknowns that share equations with each other and with the robot's alone: those of one
/// surface, of one group.
struct OwnPart {
  std::vector<int> columns;  ///< of W
  std::vector<Eigen::Index> equations;
};

/// The columns of W by what equations connect of them.
std::vector<OwnPart> own_parts(const Eigen::MatrixXd& W, const std::vector<int>& columns) {
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

/// Least squares of all equations and priors, from which rows can be taken away. With Q_p the
/// orthogonal columns of each own part, and Q those of the robot's columns beyond all parts,
///   H = Q Q^T + sum Q_p Q_p^T,
/// so that a hundred surfaces cost no more than one of as many touches.
class LeastSquares {
 public:
  LeastSquares(const Equations& equations, const State& state, const Noise& noise,
               const Prior& prior)
      : equations_(equations), noise_(noise) {
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
      put_beyond(equations, prior, dense.W, part, at, A);
      at += static_cast<Eigen::Index>(part.columns.size());
      for (const Eigen::Index i : part.equations)
        part_[static_cast<std::size_t>(i)] = static_cast<int>(parts_.size());
      parts_.push_back(std::move(part.equations));
    }
    Eigen::MatrixXd Q(A.rows(), 0);
    if (n > 0) {
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
          A.leftCols(n) * length.cwiseMax(1e-300).cwiseInverse().asDiagonal());
      const Eigen::Index rank =
          (qr.matrixQR().diagonal().cwiseAbs().array() > kNothingLeft).count();
      Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), rank);
    }
    left_ = (A.col(n) - Q * (Q.transpose() * A.col(n))).head(rows);
    Q_ = Q.topRows(rows).transpose();
    freedom_.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) freedom_[i] = product(i, i);
  }

  /// Of the rows that are not taken away.
  std::vector<Deletion> deletions() const {
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

  /// The noise is told by what is left without the row in its set, or in all of its kind where that
  /// is more, and is no less than stated.
  Standing standing(const Deletion& of) const {
    const Eigen::VectorXd left = left_ + columns(of) * least_squares(-of.part, left_(of.equations));
    const auto sets = equations_.data().sets.size();
    std::vector<char> of_kind(sets);
    for (std::size_t s = 0; s < sets; ++s) of_kind[s] = is_of_kind(static_cast<int>(s), of.set);
    const Scale& used = noise_of(of.set);
    Sum own, kind;
    for (Eigen::Index i = 0; i < left_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const int set = set_[at];
      if (set < 0 || row_[at] == of.row || row_[at] < 0 || !of_kind[static_cast<std::size_t>(set)])
        continue;
      const double square =
          std::pow(left[i] * (noise_of(set).of(quantity_[at]) / used.of(quantity_[at])), 2);
      kind.add(square, freedom_[i]);
      if (set == of.set) own.add(square, freedom_[i]);
    }
    if (!(own.freedom > 0)) return {};
    const Scale& stated = equations_.stated(of.set);
    const double sheet = std::max(stated.length / used.length, stated.angle / used.angle);
    Sum told = kind.variance() > own.variance() ? kind : own;
    if (sheet > 0) told.add(kSheet * sheet * sheet, kSheet);
    const double variance = std::max(told.variance(), std::pow(std::max(sheet, kLeastOfNoise), 2));
    const auto count = static_cast<double>(of.equations.size());
    const double ratio = of.drop / count / variance;
    return {ratio, f_exceeds(ratio, count, told.freedom)};
  }

  /// Without the row from now on.
  void take_away(const Deletion& of) {
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

 private:
  struct Sum {
    double squares = 0, freedom = 0;
    void add(double square, double one) { squares += square, freedom += one; }
    double variance() const { return squares / freedom; }
  };

  void take_quantities() {
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

  /// Takes from [robot | y] what the part's own columns explain; what their priors, in rows of A
  /// from `at` on, then ask of the robot's stands there.
  void put_beyond(const Equations& equations, const Prior& prior, const Eigen::MatrixXd& W,
                  const OwnPart& part, Eigen::Index at, Eigen::MatrixXd& A) {
    const auto count = static_cast<Eigen::Index>(part.equations.size()),
               width = static_cast<Eigen::Index>(part.columns.size());
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(count + width, width);
    std::vector<Eigen::Index> rows = part.equations;
    for (Eigen::Index j = 0; j < width; ++j) {
      const int c = part.columns[static_cast<std::size_t>(j)];
      own.col(j).head(count) = W.col(c)(part.equations);
      if (c < equations.columns()) own(count + j, j) = prior_weight(equations, prior, c);
      rows.push_back(at + j);
    }
    const Eigen::MatrixXd Q = orthogonal_columns(own).Q;
    const Eigen::MatrixXd of_others = A(rows, Eigen::all);
    A(rows, Eigen::all) = of_others - Q * (Q.transpose() * of_others);
    for (Eigen::Index i = 0; i < count; ++i)
      Q_own_[static_cast<std::size_t>(part.equations[static_cast<std::size_t>(i)])] =
          Q.row(i).transpose();
  }

  /// What two equations share by own unknowns.
  double own_product(Eigen::Index a, Eigen::Index b) const {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    return part_[i] < 0 || part_[i] != part_[j] ? 0 : Q_own_[i].dot(Q_own_[j]);
  }

  /// Of I - H, those rows taken away that are.
  double product(Eigen::Index a, Eigen::Index b) const {
    double sum = (a == b ? 1 : 0) - Q_.col(a).dot(Q_.col(b)) - own_product(a, b);
    for (const Eigen::VectorXd& each : taken_) sum -= each[a] * each[b];
    return sum;
  }

  /// The same, of the row's equations.
  Eigen::MatrixXd columns(const Deletion& of) const {
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

  bool is_of_kind(int a, int b) const {
    const Set &one = equations_.data().sets[static_cast<std::size_t>(a)],
              &other = equations_.data().sets[static_cast<std::size_t>(b)];
    return one.method->name() == other.method->name() && one.noise == other.noise &&
           one.noise_angle == other.noise_angle;
  }

  const Scale& noise_of(int set) const { return noise_.used[static_cast<std::size_t>(set)]; }

  const Equations& equations_;
  const Noise& noise_;
  Eigen::MatrixXd Q_;                             ///< Q^T, a column an equation
  std::vector<Eigen::VectorXd> Q_own_;            ///< the same of its own part
  std::vector<int> part_;                         ///< by equation; -1 without own unknowns
  std::vector<std::vector<Eigen::Index>> parts_;  ///< equations of each
  Eigen::VectorXd left_, freedom_;                ///< residuals, diagonal of I - H
  std::vector<Eigen::VectorXd> taken_;            ///< what the rows taken away take from I - H
  std::vector<int> row_, set_;                    ///< of the data set, by equation
  std::vector<Quantity> quantity_;                ///< by equation
};

/// Those that `noise` finds.
std::vector<int> standing_out(const Equations& equations, const State& state, const Noise& noise,
                              const Prior& prior, double share) {
  LeastSquares all(equations, state, noise, prior);
  std::vector<Deletion> deletions = all.deletions();
  const double expected = share * static_cast<double>(deletions.size());
  const auto most = static_cast<std::size_t>(expected + 2 * std::sqrt(expected));
  std::vector<int> rows;
  std::size_t certain = 0;
  while (rows.size() < most && !deletions.empty()) {
    std::ranges::sort(deletions, std::greater(), &Deletion::drop);
    if (deletions.size() > kMostTried) deletions.resize(kMostTried);
    std::vector<Standing> standing;
    for (const Deletion& each : deletions) standing.push_back(all.standing(each));
    const auto first = std::ranges::max_element(standing, {}, &Standing::ratio);
    const Deletion& row = deletions[static_cast<std::size_t>(first - standing.begin())];
    rows.push_back(row.row);
    if (first->chance < kMaskedByChance) certain = rows.size();
    all.take_away(row);
    deletions = all.deletions();
  }
  rows.resize(certain);
  return rows;
}

/// As its data sheets state it, where they do.
Noise as_stated(const Equations& equations, Noise noise) {
  for (std::size_t s = 0; s < noise.used.size(); ++s) {
    const Scale& stated = equations.stated(static_cast<int>(s));
    if (stated.length > 0) noise.used[s].length = stated.length;
    if (stated.angle > 0) noise.used[s].angle = stated.angle;
  }
  return noise;
}

}  // namespace

std::vector<int> masked_outliers(const Equations& equations, const State& state, const Noise& noise,
                                 const Prior& prior, double share) {
  if (free_columns(equations, prior).empty() || !are_few(equations, state)) return {};
  std::vector<int> rows = standing_out(equations, state, noise, prior, share);
  // Where false rows make the noise, the tolerances bar the way to a robot that meets the others.
  return rows.empty() ? standing_out(equations, state, as_stated(equations, noise), prior, share)
                      : rows;
}

}  // namespace selfcal
