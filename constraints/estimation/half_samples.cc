// Balanced half-samples (McCarthy 1969) of rows in the order of their times. With [R_h | z_h] the
// rows of half h at the fitted parameters and Lambda, pull the precision of the priors and what
// they ask for,
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

#include "constraints/statistics.h"
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

/// By row of the data set, 0 or 1 as its `value` is less or more than in the middle of its set; a
/// group stays whole. -1 of other rows.
std::vector<int> sides(const Equations& equations, const Eigen::VectorXd& value) {
  const Observations& rows = equations.data().rows;
  std::vector<int> of_row(static_cast<size_t>(rows.rows()), -1);
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    const std::vector<SetPlan::Item>& items = equations.plan(s).items;
    if (items.empty()) continue;
    std::map<int, std::pair<double, double>> of_group;  // sum and count
    for (const SetPlan::Item& item : items) {
      auto& [sum, count] = of_group[rows.group[item.row]];
      sum += value[item.row];
      count += 1;
    }
    std::vector<double> mine;
    for (const SetPlan::Item& item : items) {
      const int group = rows.group[item.row];
      mine.push_back(group < 0 ? value[item.row] : of_group[group].first / of_group[group].second);
    }
    const double middle = median(mine);
    for (size_t i = 0; i < items.size(); ++i)
      of_row[static_cast<size_t>(items[i].row)] = mine[i] > middle;
  }
  return of_row;
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

/// Adds up splits of one kind.
class Splits {
 public:
  Splits(const Equations& equations, const Adjusted& adjusted)
      : equations_(equations),
        adjusted_(adjusted),
        lambda_(prior_precision(equations, adjusted.prior)) {}

  /// The mean over pairs of systems of either half.
  HalfSamples over(const std::vector<std::pair<Eigen::MatrixXd, Eigen::MatrixXd>>& splits) const {
    const Eigen::Index n = equations_.columns(), of_robot = equations_.robot_columns();
    HalfSamples result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(of_robot, of_robot)};
    const auto count = static_cast<double>(splits.size());
    for (const auto& [one, other] : splits) {
      const HalfFit a = fit_of(equations_, adjusted_, one),
                    b = fit_of(equations_, adjusted_, other);
      const Eigen::VectorXd difference = (a.step - b.step) / 2;
      result.seen += difference * difference.transpose() / count;
      result.expected += (explained(b.C - a.C) + a.C.topRows(of_robot) - explained(a.C) +
                          b.C.topRows(of_robot) - explained(b.C)) /
                         (4 * count);
    }
    return result;
  }

 private:
  Eigen::MatrixXd explained(const Eigen::MatrixXd& C) const {
    return C.transpose() * lambda_.asDiagonal() * C;
  }

  const Equations& equations_;
  const Adjusted& adjusted_;
  Eigen::VectorXd lambda_;
};

}  // namespace

std::vector<HalfSamples> half_samples(const Equations& equations, const Adjusted& adjusted) {
  const Splits splits(equations, adjusted);
  const Stretches parts(equations, adjusted);
  std::vector<std::pair<Eigen::MatrixXd, Eigen::MatrixXd>> in_time;
  for (const int with : kSplits) {
    std::vector<int> left = {1, 2, 3};
    std::erase(left, with);
    in_time.emplace_back(parts.half(left[0], left[1]), parts.half(0, with));
  }
  std::vector<HalfSamples> list = {splits.over(in_time)};
  const auto part_by = [&](const Eigen::VectorXd& value) {
    const std::vector<int> side = sides(equations, value);
    const auto half = [&](int which) {
      return system_of(equations, adjusted, side, [which](int each) { return each == which; });
    };
    list.push_back(splits.over({{half(0), half(1)}}));
  };
  const Eigen::MatrixXd& q = equations.data().rows.q;
  for (Eigen::Index j = 0; j < q.cols(); ++j)
    if (q.col(j).maxCoeff() - q.col(j).minCoeff() >=
        kHardlyMoves * equations.robot().joints()[static_cast<size_t>(j)].range())
      part_by(q.col(j));
  const Eigen::MatrixXd where = where_rows_were(equations, adjusted.fitted.state);
  for (Eigen::Index a = 0; a < where.cols(); ++a) part_by(where.col(a));
  return list;
}

}  // namespace selfcal
