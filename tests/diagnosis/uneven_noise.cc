// Noise that is not the same everywhere.
#include "diagnosis/report/uneven_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "diagnosis/diagnosis.h"
#include "io/files/robot_file.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/recovery/session.h"

namespace selfcal {
namespace {

TEST(ProbabilityOfEven, IsThatOfARankCorrelation) {
  const Eigen::VectorXd squares = Eigen::VectorXd::LinSpaced(101, 0, 1).array().exp();
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(101, -3, 40).array().cube();
  // All ranks alike: ten sigma; all the other way round, as many below.
  EXPECT_NEAR(std::log(probability_of_even(squares, along) / (std::erfc(10 / std::sqrt(2.0)) / 2)),
              0, 1e-6);
  EXPECT_NEAR(probability_of_even(squares, -along), 1, 1e-12);
  // Neighbours exchanged: the sum of the squares of the ranks' differences is 100, so that the
  // correlation is 1 - 6 * 100 / (101 * 10200).
  Eigen::VectorXd exchanged = squares;
  for (Eigen::Index i = 0; i + 1 < exchanged.size(); i += 2)
    std::swap(exchanged[i], exchanged[i + 1]);
  const double z = 10 * (1 - 600 / (101 * 10200.0));
  EXPECT_NEAR(std::log(probability_of_even(exchanged, along) / (std::erfc(z / std::sqrt(2.0)) / 2)),
              0, 1e-6);
}

TEST(ProbabilityOfEven, IsUniformWhereTheNoiseIsEven) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (const int columns : {1, 3}) {
    int below_a_tenth = 0, below_a_hundredth = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Eigen::VectorXd squares =
          Eigen::VectorXd::NullaryExpr(60, [&] { return std::pow(normal(random), 2); });
      const Eigen::MatrixXd along =
          Eigen::MatrixXd::NullaryExpr(60, columns, [&] { return normal(random); });
      const double p = probability_of_even(squares, along);
      below_a_tenth += p < 0.1;
      below_a_hundredth += p < 0.01;
    }
    EXPECT_NEAR(below_a_tenth, 200, 45) << columns;
    EXPECT_NEAR(below_a_hundredth, 20, 15) << columns;
  }
}

/// A tracker sees a robot that is as its model; the noise of a row is `slow`, and `fast` more of
/// each m/s of the tool.
Diagnosis with_noise(double slow, double fast) {
  auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
  if (!loaded) std::abort();
  const std::shared_ptr<const Robot> robot = *std::move(loaded);
  const Eigen::VectorXd xi = nominal_values(*robot);
  Random random(11);
  std::normal_distribution<double> normal;
  const Node tracker = recovery::entry({{"method", "position"}});
  DataSet data = recovery::make_session(*robot, xi, {{"tracker", tracker, 120}}, 0, random).data;
  Observations& rows = data.rows;
  rows.velocity.resize(rows.rows(), rows.q.cols());
  for (int row = 0; row < rows.rows(); ++row) {
    const double quickly = std::abs(normal(random));
    for (Eigen::Index j = 0; j < rows.q.cols(); ++j)
      rows.velocity(row, j) = 0.3 * quickly * normal(random);
    const Eigen::VectorXd q = rows.q.row(row).transpose(), v = rows.velocity.row(row).transpose();
    const double speed =
        (locate(*robot, xi, q + 1e-3 * v).p - locate(*robot, xi, q).p).norm() / 1e-3;
    for (int c = 0; c < 3; ++c) rows.position(row, c) += (slow + fast * speed) * normal(random);
  }
  return diagnose(robot, data, quick());
}

TEST(UnevenNoise, ThatGrowsWithTheSpeedOfTheToolIsUnknownAndSaysSo) {
  const Diagnosis even = with_noise(50e-6, 0);
  EXPECT_EQ(even.verdict.effect, kNone) << even.why;
  EXPECT_EQ(even.uneven, "");
  const Diagnosis uneven = with_noise(20e-6, 200e-6);
  EXPECT_EQ(uneven.verdict.effect, kUnknown) << uneven.why;
  EXPECT_NE(uneven.why.find("times as much where the tool moves fast"), std::string::npos)
      << uneven.why;
}

/// A tracker sees a robot that is as its model; one reading of seven is off by `off` (rad), and the
/// noise is a twentieth of a millimetre.
Diagnosis with_every_seventh(double off) {
  auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
  if (!loaded) std::abort();
  const std::shared_ptr<const Robot> robot = *std::move(loaded);
  Random random(12);
  std::normal_distribution<double> normal;
  const Node tracker = recovery::entry({{"method", "position"}});
  DataSet data =
      recovery::make_session(*robot, nominal_values(*robot), {{"tracker", tracker, 140}}, 0, random)
          .data;
  for (int row = 0; row < data.rows.rows(); ++row) {
    for (int c = 0; c < 3; ++c) data.rows.position(row, c) += 50e-6 * normal(random);
    if (row % 7 == 4) data.rows.q(row, 1) += off * (normal(random) > 0 ? 1 : -1);
  }
  return diagnose(robot, data, quick());
}

TEST(UnevenNoise, OfOneRowInEverySevenIsUnknownAndSaysSo) {
  EXPECT_EQ(with_every_seventh(0).verdict.effect, kNone);
  for (const double off : {1e-3, 5e-3}) {  // of the rows a few, or all, are put aside as false
    const Diagnosis uneven = with_every_seventh(off);
    EXPECT_EQ(uneven.verdict.effect, kUnknown) << uneven.why;
    EXPECT_NE(uneven.why.find("in one of every 7 rows (5, 12, 19, …)"), std::string::npos)
        << uneven.why;
  }
}

}  // namespace
}  // namespace selfcal
