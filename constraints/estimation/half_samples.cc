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
constexpr double kHardlyMoves = 0.02;  // of a joint's range
/// The stretches that make the first half with the first one.
constexpr std::array kSplits = {1, 2, 3};

/// By row of the data set, the stretch of its set's rows that it is in; -1 of other rows.
std::vector<int> stretches(const Equations& equations) {
  const Observations& rows = equations.data().rows;
  const std::vector<int> order = in_time(rows);
  std::vector<int> of_row(static_cast<size_t>(rows.rows()), -1);
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    std::vector<char> here(of_row.size(), 0);
    for (const SetPlan::Item& item : equations.plan(s).items)
      here[static_cast<size_t>(item.row)] = 1;
    const auto count = static_cast<int>(equations.plan(s).items.size());
    int k = 0;
    for (const int row : order)
      if (here[static_cast<size_t>(row)])
        of_row[static_cast<size_t>(row)] = kStretches * k++ / count;
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

/// What one half of the rows and the priors give.
struct HalfFit {
  Eigen::VectorXd step;  ///< columns() entries
  Eigen::MatrixXd C;     ///< of their posterior, the robot's columns
};

/// `R` is the system of the half's rows.
HalfFit fit_of(const Equations& equations, const Adjusted& adjusted, const Eigen::MatrixXd& R) {
  const std::vector<int> columns = free_columns(equations, adjusted.prior);
  const Eigen::MatrixXd A =
      triangle_with_priors(equations, adjusted.prior, columns, R, adjusted.fitted.state.xi, true);
  const auto n = static_cast<Eigen::Index>(columns.size());
  const Eigen::MatrixXd C = inverse_of_square(A.topLeftCorner(n, n));
  HalfFit fit{Eigen::VectorXd::Zero(equations.columns()),
              Eigen::MatrixXd::Zero(equations.columns(), equations.robot_columns())};
  const Eigen::VectorXd step =
      A.topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(A.col(n).head(n));
  fit.step(columns) = step;
  const auto of_robot = static_cast<Eigen::Index>(std::ranges::count_if(
      columns, [&](int column) { return column < equations.robot_columns(); }));
  for (Eigen::Index j = 0; j < of_robot; ++j)  // they lead
    fit.C(columns, columns[static_cast<size_t>(j)]) = C.col(j);
  return fit;
}

/// The system of the rows whose part is `taken`, not yet triangular.
template <class Taken>
Eigen::MatrixXd system_of(const Equations& equations, const Adjusted& adjusted,
                          const std::vector<int>& part, Taken taken) {
  Weighting weighting{adjusted.fitted.noise.used, adjusted.fitted.noise.outlier};
  weighting.passed_over = true;
  for (size_t row = 0; row < part.size(); ++row)
    if (!taken(part[row])) weighting.outlier[row] = 1;
  return equations.linearise(adjusted.fitted.state, weighting).R;
}

/// The systems of stretches of the rows.
class Stretches {
 public:
  Stretches(const Equations& equations, const Adjusted& adjusted)
      : equations_(equations), adjusted_(adjusted), stretch_(stretches(equations)) {
    for (int k = 0; apart() && k < kStretches; ++k)
      each_.push_back(of([k](int stretch) { return stretch == k; }));
  }

  /// Of two stretches, not yet triangular.
  Eigen::MatrixXd half(int one, int other) const {
    if (each_.empty()) return of([=](int stretch) { return stretch == one || stretch == other; });
    const Eigen::MatrixXd& first = each_[static_cast<size_t>(one)];
    Eigen::MatrixXd both(2 * first.rows(), first.cols());
    both << first, each_[static_cast<size_t>(other)];
    return both;
  }

 private:
  /// Rows of a stretch share nothing with those of another but the system's unknowns.
  bool apart() const {
    return std::ranges::all_of(equations_.data().sets, [](const Set& set) {
      return set.reference < 0 && set.method->group_freedom() == 0 && !set.method->shares_touches();
    });
  }

  template <class Taken>
  Eigen::MatrixXd of(Taken taken) const {
    return system_of(equations_, adjusted_, stretch_, taken);
  }

  const Equations& equations_;
  const Adjusted& adjusted_;
  std::vector<int> stretch_;
  std::vector<Eigen::MatrixXd> each_;  ///< by stretch, where these are apart
};

/// The mean over `splits`: pairs of the systems of either half.
HalfSamples over(const Equations& equations, const Adjusted& adjusted,
                 const std::vector<std::pair<Eigen::MatrixXd, Eigen::MatrixXd>>& splits) {
  const Eigen::Index n = equations.columns(), of_robot = equations.robot_columns();
  const Eigen::VectorXd lambda = prior_precision(equations, adjusted.prior);
  HalfSamples result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(of_robot, of_robot)};
  const auto explained = [&](const Eigen::MatrixXd& C) -> Eigen::MatrixXd {
    return C.transpose() * lambda.asDiagonal() * C;
  };
  const auto count = static_cast<double>(splits.size());
  for (const auto& [one, other] : splits) {
    const HalfFit a = fit_of(equations, adjusted, one), b = fit_of(equations, adjusted, other);
    const Eigen::VectorXd difference = (a.step - b.step) / 2;
    const Eigen::MatrixXd shrunk = b.C - a.C;
    result.seen += difference * difference.transpose() / count;
    result.expected += (explained(shrunk) + a.C.topRows(of_robot) - explained(a.C) +
                        b.C.topRows(of_robot) - explained(b.C)) /
                       (4 * count);
  }
  return result;
}

}  // namespace

HalfSampling half_samples(const Equations& equations, const Adjusted& adjusted) {
  const Stretches parts(equations, adjusted);
  std::vector<std::pair<Eigen::MatrixXd, Eigen::MatrixXd>> in_time;
  for (const int with : kSplits) {
    std::vector<int> left = {1, 2, 3};
    std::erase(left, with);
    in_time.emplace_back(parts.half(left[0], left[1]), parts.half(0, with));
  }
  HalfSampling sampling{over(equations, adjusted, in_time), {}};
  const auto part_by = [&](const Eigen::VectorXd& value) {
    const std::vector<int> side = sides(equations, value);
    const auto half = [&](int which) {
      return system_of(equations, adjusted, side, [which](int each) { return each == which; });
    };
    sampling.by_configuration.push_back(over(equations, adjusted, {{half(0), half(1)}}));
  };
  const Eigen::MatrixXd& q = equations.data().rows.q;
  for (int j = 0; j < static_cast<int>(q.cols()); ++j)
    if (moves(equations, j)) part_by(q.col(j));
  const Eigen::MatrixXd where = where_rows_were(equations, adjusted.fitted.state);
  for (Eigen::Index a = 0; a < where.cols(); ++a) part_by(where.col(a));
  return sampling;
}

}  // namespace selfcal
