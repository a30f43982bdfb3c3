#include "constraints/fitting/masked_outlier.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kChance = 1e-6;
constexpr Eigen::Index kMostEquations = 3000;     ///< with more, none bends the fit alone
constexpr Eigen::Index kMostEntries = 1'000'000;  ///< of the equations held at once
constexpr std::size_t kMostTried = 20;            ///< those whose absence makes most difference

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

/// Least squares of all equations and priors, from which every row can be taken away.
class LeastSquares {
 public:
  LeastSquares(const Equations& equations, const State& state, const Noise& noise,
               const Prior& prior)
      : equations_(equations), noise_(noise) {
    const DenseEquations dense = equations.dense(state, noise.used, noise.outlier);
    const Eigen::Index rows = dense.y.size();
    std::vector<int> columns = free_columns(equations, prior);
    const auto own = static_cast<Eigen::Index>(columns.size());
    for (Eigen::Index c = equations.columns(); c < dense.W.cols(); ++c)
      columns.push_back(static_cast<int>(c));
    Eigen::MatrixXd A =
        Eigen::MatrixXd::Zero(rows + own, static_cast<Eigen::Index>(columns.size()));
    Eigen::VectorXd y = Eigen::VectorXd::Zero(rows + own);
    A.topRows(rows) = dense.W(Eigen::all, columns);
    y.head(rows) = dense.y;
    for (Eigen::Index i = 0; i < own; ++i) {
      const int c = columns[static_cast<std::size_t>(i)];
      const double weight = prior_weight(equations, prior, c);
      A(rows + i, i) = weight;
      if (c < equations.robot_columns()) y[rows + i] = weight * (prior.centre[c] - state.xi[c]);
    }
    const Eigen::MatrixXd Q = orthogonal_columns(A).Q;
    left_ = (y - Q * transposed_product(Q, y)).head(rows);
    Q_ = Q.topRows(rows);
    row_ = dense.row;
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
      const Eigen::MatrixXd Q = Q_(own, Eigen::all);
      Deletion each{row, equations_.data().rows.set[static_cast<std::size_t>(row)], std::move(own),
                    Eigen::MatrixXd::Identity(count, count) - Q * Q.transpose(), 0};
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
    const Eigen::VectorXd pull =
        Q_(of.equations, Eigen::all).transpose() * least_squares(of.part, left_(of.equations));
    Sum own, kind;
    for (Eigen::Index i = 0; i < left_.size(); ++i) {
      const int set = set_of(i);
      if (set < 0 || row_[static_cast<std::size_t>(i)] == of.row || !of_kind(set, of.set)) continue;
      const double square =
          std::pow((left_[i] + Q_.row(i).dot(pull)) * relative_noise(i, set, of.set), 2);
      const double freedom = 1 - Q_.row(i).squaredNorm();
      kind.add(square, freedom);
      if (set == of.set) own.add(square, freedom);
    }
    if (!(own.freedom > 0)) return 1;
    const Scale &stated = equations_.stated(of.set), &used = noise_of(of.set);
    const double least =
        std::max({stated.length / used.length, stated.angle / used.angle, kLeastNoise});
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

  int set_of(Eigen::Index equation) const {
    const int row = row_[static_cast<std::size_t>(equation)];
    return row < 0 ? -1 : equations_.data().rows.set[static_cast<std::size_t>(row)];
  }

  bool of_kind(int a, int b) const {
    const Set &one = equations_.data().sets[static_cast<std::size_t>(a)],
              &other = equations_.data().sets[static_cast<std::size_t>(b)];
    return one.method->name() == other.method->name() && one.noise == other.noise &&
           one.noise_angle == other.noise_angle;
  }

  const Scale& noise_of(int set) const { return noise_.used[static_cast<std::size_t>(set)]; }

  /// What an equation of `set` is weighed by over what one of `other` is.
  double relative_noise(Eigen::Index equation, int set, int other) const {
    Eigen::Index first = equation;
    while (first > 0 &&
           row_[static_cast<std::size_t>(first - 1)] == row_[static_cast<std::size_t>(equation)])
      --first;
    const Quantity quantity = equations_.data()
                                  .sets[static_cast<std::size_t>(set)]
                                  .method->equations()[static_cast<std::size_t>(equation - first)];
    return noise_of(set).of(quantity) / noise_of(other).of(quantity);
  }

  const Equations& equations_;
  const Noise& noise_;
  Eigen::MatrixXd Q_;     ///< of the rows, above the priors
  Eigen::VectorXd left_;  ///< residuals
  std::vector<int> row_;  ///< of the data set, by equation
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
  double least = kChance;
  for (const Deletion& each : deletions)
    if (const double chance = all.chance(each); chance < least) {
      least = chance;
      row = each.row;
    }
  return row;
}

}  // namespace selfcal
