// A false touch of high leverage bends the model to itself and makes good ones look false.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "constraints/estimation/identification.h"
#include "constraints/fitting/masked_outlier.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

/// So few touches of four planes that most have a high leverage: 20 um of noise.
Simulated few_touches(int seed) {
  const auto plane = [](const std::string& name, const std::string& surface) {
    return "  " + name + ": {method: plane, rows: 20, noise: 2.0e-5, surface: {" + surface + "}}\n";
  };
  return made("robot: rx90.robot.yaml\nseed: " + std::to_string(seed) +
              "\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets:\n" +
              plane("table", "point: [0.6, 0, 0.2], normal: [0, 0, 1]") +
              plane("wall", "point: [0.7, 0, 0.6], normal: [-1, 0, 0]") +
              plane("side", "point: [0.4, 0.6, 0.5], normal: [0, -1, 0]") +
              plane("ramp", "point: [0.5, -0.3, 0.3], normal: [0, 0.6, 0.8]"));
}

constexpr double kShare = 0.05;  ///< of the rows: Options::most_outliers

/// Rows that identify.
std::vector<int> fit_rows(const DataSet& data) {
  std::vector<int> rows;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (!data.rows.check[row]) rows.push_back(row);
  return rows;
}

/// Distance of a row's touch from its surface (m).
double off(const Simulated& simulated, int row) {
  for (const RowResidual& each : residuals_at_truth(simulated))
    if (each.row == row) return each.length;
  return 0;
}

TEST(MaskedOutlier, IsFoundWhereverItIsAndNoGoodRowForIt) {
  int missed = 0, innocent = 0, tried = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    const Simulated simulated = few_touches(seed);
    for (const int row : fit_rows(simulated.data)) {
      Simulated wrong = simulated;
      wrong.data.rows.q(row, 1) += 3e-3;
      if (off(wrong, row) < 1e-3) continue;
      const Solution solution = identify(rx90(), wrong.data, {}, {});
      bool found = false;
      for (const Outlier& each : solution.outliers) {
        if (each.row == row + 1)
          found = true;
        else if (!each.check)
          ++innocent;
      }
      ++tried;
      missed += found ? 0 : 1;
    }
  }
  std::printf("%d false rows, one at a time: %d missed, %d good ones put aside\n", tried, missed,
              innocent);
  EXPECT_GT(tried, 80);
  EXPECT_LE(missed, 0.15 * tried) << "half of them where each row's own residual is looked at";
  EXPECT_LE(innocent, 0.02 * tried);
}

/// Each of three false rows, 5 to 20 mm off, may hide in the noise that the others make.
TEST(MaskedOutliers, AreFoundThatHideEachOther) {
  int missed = 0, innocent = 0, tried = 0;
  for (int seed = 41; seed <= 50; ++seed) {
    Simulated wrong = few_touches(seed);
    const std::vector<int> rows = fit_rows(wrong.data);
    std::set<int> is_false;
    for (std::size_t i = 0; i < rows.size() && is_false.size() < 3; i += 9) {
      wrong.data.rows.q(rows[i], 1) += 20e-3;
      if (const double by = off(wrong, rows[i]); by > 5e-3 && by < 20e-3)
        is_false.insert(rows[i] + 1);
      else
        wrong.data.rows.q(rows[i], 1) -= 20e-3;
    }
    tried += static_cast<int>(is_false.size());
    for (const Outlier& each : identify(rx90(), wrong.data, {}, {}).outliers)
      if (!each.check && is_false.erase(each.row) == 0) ++innocent;
    missed += static_cast<int>(is_false.size());
  }
  std::printf("%d false rows, three at a time: %d missed, %d good ones put aside\n", tried, missed,
              innocent);
  EXPECT_GT(tried, 25);
  EXPECT_LE(missed, 0.15 * tried);
  EXPECT_LE(innocent, 0.02 * tried);
}

TEST(MaskedOutlier, IsNoneOfGoodRows) {
  for (int seed = 11; seed <= 30; ++seed) {
    const Solution solution = identify(rx90(), few_touches(seed).data, {}, {});
    EXPECT_TRUE(std::ranges::all_of(solution.outliers, &Outlier::check)) << "seed " << seed;
  }
}

TEST(MaskedOutlier, IsNoneWhereNothingIsFreeThatItCouldBend) {
  Simulated simulated =
      made("robot: rx90.robot.yaml\nsets: {tracker: {method: position, rows: 90}}\n");
  simulated.data.rows.q(fit_rows(simulated.data).front(), 1) += 3e-3;
  const Equations equations(rx90(), simulated.data, Use::fit);
  Prior prior;
  prior.free.assign(static_cast<std::size_t>(equations.robot_columns()), 0);
  const Noise noise{{}, {Scale{2e-5, 1}}, std::vector<char>(90, 0), {}};
  EXPECT_TRUE(masked_outliers(equations, simulated.truth, noise, prior, kShare).empty());
}

// The largest externally studentised residual of a regression, by refitting without each row.
TEST(MaskedOutlier, IsTheRowWhoseAbsenceLeavesLeastOfItsSet) {
  const Simulated simulated = few_touches(5);
  DataSet data = simulated.data;
  const int row = fit_rows(data)[7];
  data.rows.q(row, 1) += 3e-3;
  const Equations equations(rx90(), data, Use::fit);
  Prior prior;
  prior.centre = simulated.truth.xi;
  prior.sigma = Eigen::VectorXd::Constant(prior.centre.size(), 1e-9);
  prior.free.assign(static_cast<std::size_t>(prior.centre.size()), 0);
  Noise noise;
  noise.used.assign(data.sets.size(), Scale{2e-5, 1});
  noise.outlier.assign(static_cast<std::size_t>(data.rows.rows()), 0);
  EXPECT_EQ(masked_outliers(equations, simulated.truth, noise, prior, kShare), std::vector{row});
  noise.outlier[static_cast<std::size_t>(row)] = 1;
  EXPECT_TRUE(masked_outliers(equations, simulated.truth, noise, prior, kShare).empty());
}

/// The same with every parameter free, column by column: by how much the sum of squares falls
/// without each row, over what is left of a freedom.
int row_of_most_by_refits(const DenseEquations& dense, const Eigen::VectorXd& weights) {
  const Eigen::Index n = dense.y.size();
  const auto squares_without = [&](int row) {
    Eigen::MatrixXd A(n + weights.size(), weights.size());
    Eigen::VectorXd y = Eigen::VectorXd::Zero(A.rows());
    A << dense.W, Eigen::MatrixXd(weights.asDiagonal());
    y.head(n) = dense.y;
    for (Eigen::Index i = 0; i < n; ++i)
      if (dense.row[static_cast<std::size_t>(i)] == row) {
        A.row(i).setZero();
        y[i] = 0;
      }
    return (y - A * A.colPivHouseholderQr().solve(y)).squaredNorm();
  };
  const double all = squares_without(-1);
  int most = -1;
  double largest = 0;
  for (const int row : dense.row) {
    const double left = squares_without(row);
    if ((all - left) / left <= largest) continue;
    largest = (all - left) / left;
    most = row;
  }
  return most;
}

TEST(MaskedOutlier, IsThatOfAllColumnsTogether) {
  for (const int at : {3, 20, 40}) {
    const Simulated simulated = few_touches(6);
    DataSet data = simulated.data;
    data.rows.q(fit_rows(data)[static_cast<std::size_t>(at)], 1) += 20e-3;
    const Equations equations(rx90(), data, Use::fit);
    Prior prior;
    prior.centre = simulated.truth.xi;
    prior.sigma = Eigen::VectorXd::Constant(prior.centre.size(), 1e-3);
    prior.free.assign(static_cast<std::size_t>(prior.centre.size()), 1);
    Noise noise;
    noise.used.assign(data.sets.size(), Scale{2e-5, 1});
    noise.outlier.assign(static_cast<std::size_t>(data.rows.rows()), 0);
    Eigen::VectorXd weights(equations.columns());
    for (int c = 0; c < equations.columns(); ++c) weights[c] = prior_weight(equations, prior, c);
    EXPECT_EQ(masked_outliers(equations, simulated.truth, noise, prior, kShare).front(),
              row_of_most_by_refits(equations.dense(simulated.truth, noise.used, noise.outlier),
                                    weights));
  }
}

}  // namespace
}  // namespace selfcal
