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

/// What a row's absence does to the least squares.
struct Deletion {
  int row = 0, set = 0;
  std::vector<Eigen::Index> equations;
  Eigen::MatrixXd part;  ///< I - H of its equations
  double drop = 0;       ///< of the sum of squares
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

/// Least squares of all equations and priors, from which every row can be taken away. With Q_p the
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
    leverage_ = Q_.colwise().squaredNorm().transpose();
    for (Eigen::Index i = 0; i < rows; ++i) leverage_[i] += own_product(i, i);
  }

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
      Eigen::MatrixXd part = Eigen::MatrixXd::Identity(count, count);
      for (Eigen::Index a = 0; a < count; ++a)
        for (Eigen::Index b = 0; b < count; ++b)
          part(a, b) -=
              Q_.col(own[static_cast<std::size_t>(a)])
                  .dot(Q_.col(own[static_cast<std::size_t>(b)])) +
              own_product(own[static_cast<std::size_t>(a)], own[static_cast<std::size_t>(b)]);
      Deletion each{row, equations_.data().rows.set[static_cast<std::size_t>(row)], std::move(own),
                    std::move(part), 0};
      const Eigen::VectorXd left = left_(each.equations);
      each.drop = left.dot(least_squares(each.part, left));
      list.push_back(std::move(each));
    }
    return list;
  }

  /// That a good row's absence lowers the sum of squares as much. The noise is told by what is left
  /// without the row in its set, or in all of its kind where that is more, and is no less than
  /// stated.
  double chance(const Deletion& of) const {
    const Eigen::VectorXd left = left_without(of);
    const auto sets = equations_.data().sets.size();
    std::vector<char> of_kind(sets);
    for (std::size_t s = 0; s < sets; ++s) of_kind[s] = is_of_kind(static_cast<int>(s), of.set);
    const Scale& used = noise_of(of.set);
    Sum own, kind;
    for (Eigen::Index i = 0; i < left_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const int set = set_[at];
      if (set < 0 || row_[at] == of.row || !of_kind[static_cast<std::size_t>(set)]) continue;
      const double square =
          std::pow(left[i] * (noise_of(set).of(quantity_[at]) / used.of(quantity_[at])), 2);
      kind.add(square, 1 - leverage_[i]);
      if (set == of.set) own.add(square, 1 - leverage_[i]);
    }
    if (!(own.freedom > 0)) return 1;
    const Scale& stated = equations_.stated(of.set);
    const double least =
        std::max({stated.length / used.length, stated.angle / used.angle, kLeastOfNoise});
    const Sum& told = kind.variance() > own.variance() ? kind : own;
    const double variance = std::max(told.variance(), least * least);
    const auto count = static_cast<double>(of.equations.size());
    return f_exceeds(of.drop / count / variance, count, told.freedom);
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

  /// The residuals without the row.
  Eigen::VectorXd left_without(const Deletion& of) const {
    const Eigen::VectorXd off = least_squares(of.part, left_(of.equations));
    const Eigen::VectorXd pull = Q_(Eigen::all, of.equations) * off;
    Eigen::VectorXd left = left_ + Q_.transpose() * pull;
    for (std::size_t k = 0; k < of.equations.size(); ++k) {
      const Eigen::Index one = of.equations[k];
      const int part = part_[static_cast<std::size_t>(one)];
      if (part < 0) continue;
      for (const Eigen::Index i : parts_[static_cast<std::size_t>(part)])
        left[i] += own_product(i, one) * off[static_cast<Eigen::Index>(k)];
    }
    return left;
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
  Eigen::VectorXd left_, leverage_;               ///< residuals, diagonal of H
  std::vector<int> row_, set_;                    ///< of the data set, by equation
  std::vector<Quantity> quantity_;                ///< by equation
};

}  // namespace

std::optional<int> masked_outlier(const Equations& equations, const State& state,
                                  const Noise& noise, const Prior& prior) {
  if (free_columns(equations, prior).empty() || !are_few(equations, state)) return std::nullopt;
  const LeastSquares all(equations, state, noise, prior);
  std::vector<Deletion> deletions = all.deletions();
  std::ranges::sort(deletions, std::greater(), &Deletion::drop);
  if (deletions.size() > kMostTried) deletions.resize(kMostTried);
  std::optional<int> row;
  double least = kMaskedByChance;
  for (const Deletion& each : deletions)
    if (const double chance = all.chance(each); chance < least) {
      least = chance;
      row = each.row;
    }
  return row;
}

}  // namespace selfcal
