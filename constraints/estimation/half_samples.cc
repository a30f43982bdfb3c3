// Balanced half-samples (McCarthy 1969) of the rows. With [R_h | z_h] the rows of half h at the
// fitted parameters and Lambda, pull the precision of the priors and what they ask for,
//   s_h = C_h (R_h^T z_h + pull),   C_h = (R_h^T R_h + Lambda)^-1,   difference (s_1 - s_2) / 2,
// whose square is expected to be, where the rows err apart and the truth is as the priors say,
//   ((C_2 - C_1) Lambda (C_2 - C_1) + sum_h (C_h - C_h Lambda C_h)) / 4.
// Rows soon after each other, or near each other in the readings of a joint or in the cell, share
// what the model lacks (a temperature, a series; a link that bends, a beam); in a half they do so
// all together, and the halves show by how much.
#include "constraints/estimation/half_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kStretches = 4;
/// Of a column's squares, that another one is told apart by at least.
constexpr double kUntold = 1e-10;
constexpr double kHardlyMoves = 0.02;  // of a joint's range
/// The stretches that make the first half with the first one.
constexpr std::array<int, kHalvesInTime> kSplits = {1, 2, 3};

/// By row of the data set, 0 in the first of four stretches of its set's rows in the order of their
/// times and in stretch `with`, 1 in the other two; -1 of other rows.
std::vector<int> in_time_with(int with, const Equations& equations) {
  const Observations& rows = equations.data().rows;
  const std::vector<int> order = in_time(rows);
  std::vector<int> of_row(static_cast<size_t>(rows.rows()), -1);
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    std::vector<char> here(of_row.size(), 0);
    for (const SetPlan::Item& item : equations.plan(s).items)
      here[static_cast<size_t>(item.row)] = 1;
    const auto count = static_cast<int>(equations.plan(s).items.size());
    int k = 0;
    for (const int row : order) {
      if (!here[static_cast<size_t>(row)]) continue;
      const int stretch = kStretches * k++ / count;
      of_row[static_cast<size_t>(row)] = stretch == 0 || stretch == with ? 0 : 1;
    }
  }
  return of_row;
}

/// What stays in one half: a group's rows, or the repeats of one configuration, or one row.
std::pair<int, int> whole_of(const Observations& rows, int row) {
  if (rows.group[row] >= 0) return {0, rows.group[row]};
  if (!rows.repeat.empty() && rows.repeat[row] >= 0) return {1, rows.repeat[row]};
  return {2, row};
}

/// By row of the data set, 0 for the half of its set with the less `value` and 1 for the rest; by
/// turns where the set has but one. -1 of other rows.
std::vector<int> sides(const Equations& equations, const Eigen::VectorXd& value) {
  const Observations& rows = equations.data().rows;
  std::vector<int> of_row(static_cast<size_t>(rows.rows()), -1);
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    struct Whole {
      double sum = 0;
      std::vector<int> rows;
      double mean() const { return sum / static_cast<double>(rows.size()); }
    };
    std::map<std::pair<int, int>, Whole> wholes;
    for (const SetPlan::Item& item : equations.plan(s).items) {
      Whole& whole = wholes[whole_of(rows, item.row)];
      whole.sum += value[item.row];
      whole.rows.push_back(item.row);
    }
    std::vector<const Whole*> order;
    for (const auto& [key, whole] : wholes) order.push_back(&whole);
    std::ranges::stable_sort(order, {}, &Whole::mean);
    // The cut between two values that is nearest to the middle of the rows.
    const size_t all = equations.plan(s).items.size();
    size_t cut = 0, before = 0, least = all;
    for (size_t i = 0; i + 1 < order.size(); ++i) {
      before += order[i]->rows.size();
      const size_t off = 2 * before > all ? 2 * before - all : all - 2 * before;
      if (order[i]->mean() == order[i + 1]->mean() || off >= least) continue;
      least = off;
      cut = i + 1;
    }
    for (size_t i = 0; i < order.size(); ++i)
      for (const int row : order[i]->rows)
        of_row[static_cast<size_t>(row)] = cut > 0 ? i >= cut : static_cast<int>(i % 2);
  }
  return of_row;
}

/// Whether the rows that identify move joint `j` at all.
bool moves(const Equations& equations, int j) {
  double least = INFINITY, most = -INFINITY;
  for (size_t s = 0; s < equations.data().sets.size(); ++s)
    for (const SetPlan::Item& item : equations.plan(static_cast<int>(s)).items) {
      least = std::min(least, equations.data().rows.q(item.row, j));
      most = std::max(most, equations.data().rows.q(item.row, j));
    }
  return most - least >= kHardlyMoves * equations.robot().joints()[static_cast<size_t>(j)].range();
}

/// By row of the data set, where its body was (m, world); zero of rows that identify nothing.
Eigen::MatrixXd where_rows_were(const Equations& equations, const State& state) {
  Eigen::MatrixXd where = Eigen::MatrixXd::Zero(equations.data().rows.rows(), 3);
  const std::vector<RowPlace> places = equations.places(state);
  auto place = places.begin();
  for (size_t s = 0; s < equations.data().sets.size(); ++s)
    for (const SetPlan::Item& item : equations.plan(static_cast<int>(s)).items)
      where.row(item.row) = (place++)->at.transpose();
  return where;
}

/// Fits of halves of the rows.
class HalfFits {
 public:
  HalfFits(const Equations& equations, const Adjusted& adjusted)
      : equations_(equations),
        fitted_(adjusted.fitted),
        columns_(free_columns(equations, adjusted.prior)) {
    const Eigen::MatrixXd R = fitted_.at.R(Eigen::all, columns_);
    all_ = {transposed_product(R, R), R.transpose() * fitted_.at.R.rightCols<1>()};
    lambda_ = prior_precision(equations, adjusted.prior)(columns_);
    robot_ = static_cast<Eigen::Index>(std::ranges::count_if(
        columns_, [&](int column) { return column < equations_.robot_columns(); }));  // they lead
    apart_ = std::ranges::all_of(equations.data().sets, [](const Set& set) {
      return set.reference < 0 && set.method->group_freedom() == 0 && !set.method->shares_touches();
    });
    pull_.setZero(lambda_.size());
    for (Eigen::Index i = 0; i < robot_; ++i) {
      const int column = columns_[static_cast<size_t>(i)];
      pull_[i] = lambda_[i] * (adjusted.prior.centre[column] - fitted_.state.xi[column]);
    }
  }

  /// The mean over ways to make two halves.
  HalfSamples over(const std::vector<std::vector<int>>& splits) const {
    const Eigen::Index n = equations_.columns(), of_robot = equations_.robot_columns();
    HalfSamples result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(of_robot, of_robot)};
    const auto explained = [&](const Eigen::MatrixXd& C) -> Eigen::MatrixXd {
      return transposed_product(C, lambda_.asDiagonal() * C);
    };
    const std::vector<int> robot(columns_.begin(), columns_.begin() + robot_);
    const auto count = static_cast<double>(splits.size());
    for (const std::vector<int>& side : splits) {
      const Products first = of(side, 0);
      const Products second = apart_ ? Products{all_.N - first.N, all_.g - first.g} : of(side, 1);
      const HalfFit a = fit_of(first), b = fit_of(second);
      Eigen::VectorXd difference = Eigen::VectorXd::Zero(n);
      difference(columns_) = (a.step - b.step) / 2;
      result.seen += difference * difference.transpose() / count;
      result.expected(robot, robot) += (explained(b.C - a.C) + a.C.topRows(robot_) -
                                        explained(a.C) + b.C.topRows(robot_) - explained(b.C)) /
                                       (4 * count);
    }
    return result;
  }

 private:
  struct Products {
    Eigen::MatrixXd N;  ///< R^T R
    Eigen::VectorXd g;  ///< R^T z
  };
  struct HalfFit {
    Eigen::VectorXd step;
    Eigen::MatrixXd C;  ///< of the posterior, the robot's columns
  };

  Products of(const std::vector<int>& side, int which) const {
    Weighting weighting{fitted_.noise.used, fitted_.noise.outlier};
    weighting.passed_over = true;
    for (size_t row = 0; row < side.size(); ++row)
      if (side[row] != which) weighting.outlier[row] = 1;
    const Eigen::MatrixXd H = equations_.normal_equations(fitted_.state, weighting, columns_).H;
    const Eigen::Index n = H.cols() - 1;
    return {H.topLeftCorner(n, n), H.col(n).head(n)};
  }

  /// What a half does not tell of a set's own unknowns is left where it is.
  HalfFit fit_of(const Products& half) const {
    Eigen::MatrixXd A = half.N;
    A.diagonal() += lambda_;
    const Eigen::VectorXd unit =
        A.diagonal().unaryExpr([](double each) { return each > 0 ? 1 / std::sqrt(each) : 0; });
    A = unit.asDiagonal() * A * unit.asDiagonal();
    A.diagonal().array() += kUntold;
    const Eigen::MatrixXd L = cholesky_root(A);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(A.rows(), robot_ + 1);
    right.leftCols(robot_).diagonal() = unit.head(robot_);
    right.col(robot_) = unit.cwiseProduct(half.g + pull_);
    const Eigen::MatrixXd X = unit.asDiagonal() * solve_lower_transposed(L, solve_lower(L, right));
    return {X.col(robot_), X.leftCols(robot_)};
  }

  const Equations& equations_;
  const Fit& fitted_;
  std::vector<int> columns_;
  bool apart_ = true;       ///< rows of one half share nothing with the other's but these unknowns
  Eigen::Index robot_ = 0;  ///< of them, how many are the robot's
  Products all_;
  Eigen::VectorXd lambda_, pull_;
};

}  // namespace

HalfSampling half_samples(const Equations& equations, const Adjusted& adjusted) {
  const HalfFits fits(equations, adjusted);
  std::vector<std::vector<int>> in_time;
  for (const int with : kSplits) in_time.push_back(in_time_with(with, equations));
  HalfSampling sampling{fits.over(in_time), {}};
  const auto part_by = [&](const Eigen::VectorXd& value) {
    sampling.by_configuration.push_back(fits.over({sides(equations, value)}));
  };
  const Eigen::MatrixXd& q = equations.data().rows.q;
  for (int j = 0; j < static_cast<int>(q.cols()); ++j)
    if (moves(equations, j)) part_by(q.col(j));
  const Eigen::MatrixXd where = where_rows_were(equations, adjusted.fitted.state);
  for (Eigen::Index a = 0; a < where.cols(); ++a) part_by(where.col(a));
  return sampling;
}

}  // namespace selfcal
