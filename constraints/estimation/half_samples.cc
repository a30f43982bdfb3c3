// Balanced half-samples (McCarthy 1969) of rows in the order of their times. With [R_h | z_h] the
// rows of half h at the fitted parameters and Lambda, pull the precision of the priors and what
// they ask for,
//   s_h = C_h (R_h^T z_h + pull),   C_h = (R_h^T R_h + Lambda)^-1,   difference (s_1 - s_2) / 2,
// whose square is expected to be, where the rows err apart and the truth is as the priors say,
//   ((C_2 - C_1) Lambda (C_2 - C_1) + sum_h (C_h - C_h Lambda C_h)) / 4.
// Rows soon after each other share what the model lacks (a region of the cell, a temperature, a
// series); in a stretch they do so all together, and the halves show by how much.
#include "constraints/estimation/half_samples.h"

#include <algorithm>
#include <array>
#include <vector>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kStretches = 4;
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

/// The systems of parts of the rows.
class Parts {
 public:
  Parts(const Equations& equations, const Adjusted& adjusted)
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
    Weighting part{adjusted_.fitted.noise.used, adjusted_.fitted.noise.outlier};
    part.passed_over = true;
    for (size_t row = 0; row < stretch_.size(); ++row)
      if (!taken(stretch_[row])) part.outlier[row] = 1;
    return equations_.linearise(adjusted_.fitted.state, part).R;
  }

  const Equations& equations_;
  const Adjusted& adjusted_;
  std::vector<int> stretch_;
  std::vector<Eigen::MatrixXd> each_;  ///< by stretch, where these are apart
};

}  // namespace

HalfSamples half_samples(const Equations& equations, const Adjusted& adjusted) {
  const Eigen::Index n = equations.columns(), of_robot = equations.robot_columns();
  const Eigen::VectorXd lambda = prior_precision(equations, adjusted.prior);
  HalfSamples result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(of_robot, of_robot)};
  const auto explained = [&](const Eigen::MatrixXd& C) -> Eigen::MatrixXd {
    return C.transpose() * lambda.asDiagonal() * C;
  };
  const Parts parts(equations, adjusted);
  for (const int with : kSplits) {
    std::vector<int> left = {1, 2, 3};
    std::erase(left, with);
    const HalfFit a = fit_of(equations, adjusted, parts.half(left[0], left[1])),
                  b = fit_of(equations, adjusted, parts.half(0, with));
    const Eigen::VectorXd difference = (a.step - b.step) / 2;
    const Eigen::MatrixXd shrunk = b.C - a.C;
    result.seen += difference * difference.transpose() / kSplits.size();
    result.expected += (explained(shrunk) + a.C.topRows(of_robot) - explained(a.C) +
                        b.C.topRows(of_robot) - explained(b.C)) /
                       (4.0 * kSplits.size());
  }
  return result;
}

}  // namespace selfcal
