// A step in the mean, against numbers worked by hand and the stated rate of false alarms.
#include "constraints/estimation/change_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace selfcal {
namespace {

constexpr int kFewest = 5;

/// Twelve rows, x +1 and -1 in turn; y rises by 3 after the sixth.
Eigen::MatrixXd stepped_rows() {
  Eigen::MatrixXd rows(12, 2);
  for (int i = 0; i < 12; ++i) rows.row(i) << (i % 2 == 0 ? 1 : -1), (i < 6 ? 0 : 3);
  return rows;
}

TEST(ChangePoint, IsFoundWhereTheMeanSteps) {
  const auto found = change_point(stepped_rows(), 0, kFewest);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->at, 6);
  EXPECT_NEAR(found->step.x(), 0, 1e-12);  // rounding, as below
  EXPECT_NEAR(found->step.y(), 3, 1e-12);
  // Ten of eleven differences are (2, 0): sigma² = 4 / (2 * 2 ln 2); 6 * 6 / 12 * 3² = 27.
  EXPECT_NEAR(found->statistic, 27 * std::log(2.0), 1e-4);  // the median of chi is in a table
  // Three splits; F(2, 7.2) exceeds x with (1 + 2 x / 7.2)^-3.6.
  EXPECT_NEAR(found->p_value, 3 * std::pow(1 + 27 * std::log(2.0) / 7.2, -3.6), 1e-4);
}

TEST(ChangePoint, TakesNoLessThanTheStatedNoise) {
  EXPECT_NEAR(change_point(stepped_rows(), 2, kFewest)->statistic, 27.0 / 4, 1e-12);
}

TEST(ChangePoint, LeavesAHandfulOfRowsOnEitherSide) {
  Eigen::MatrixXd rows = stepped_rows();
  rows.bottomRows<6>().col(1).setZero();
  rows.bottomRows<2>().col(1).setConstant(50);
  EXPECT_EQ(change_point(rows, 0, kFewest)->at, 7);
  EXPECT_FALSE(change_point(rows.topRows(9), 0, kFewest));
}

/// Share of 1000 sets in which a step is seen at probability `p`.
double share_seen(int count, double p, double step, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 2e-5);
  int seen = 0;
  for (int set = 0; set < 1000; ++set) {
    Eigen::MatrixXd rows(count, 2);
    for (double& each : rows.reshaped()) each = noise(random);
    rows.bottomRows(count / 3).col(0).array() += step;
    seen += change_point(rows, 0, kFewest)->p_value <= p;
  }
  return seen / 1000.0;
}

TEST(ChangePoint, IsSeenInCleanRowsNoMoreOftenThanStated) {
  for (const int count : {12, 30, 100}) {
    // Three sigma of a thousand sets above the rate.
    EXPECT_LE(share_seen(count, 0.05, 0, 1), 0.05 + 3 * std::sqrt(0.05 / 1000)) << count;
    EXPECT_LE(share_seen(count, 0.01, 0, 2), 0.01 + 3 * std::sqrt(0.01 / 1000)) << count;
    EXPECT_LE(share_seen(count, 0.001, 0, 3), 0.001 + 3 * std::sqrt(0.001 / 1000)) << count;
  }
}

TEST(ChangePoint, IsNotMadeOfOneFalseRow) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 2e-5);
  Eigen::MatrixXd rows(40, 2);
  for (double& each : rows.reshaped()) each = noise(random);
  const double without = change_point(rows, 0, kFewest)->p_value;
  for (const int at : {0, 1, 9, 20, 38, 39}) {
    Eigen::MatrixXd spoilt = rows;
    spoilt(at, 1) += 0.1;
    EXPECT_GT(change_point(spoilt, 0, kFewest)->p_value, without / 100) << at;
  }
  // Beside a true one it moves nothing.
  rows.bottomRows(20).col(0).array() += 1e-3;
  rows(9, 1) += 0.1;
  EXPECT_EQ(change_point(rows, 0, kFewest)->at, 20);
}

TEST(ChangePoint, IsNotMissedAtFiveTimesTheNoise) {
  EXPECT_GE(share_seen(30, 0.001, 1e-4, 4), 0.999);
}

}  // namespace
}  // namespace selfcal
