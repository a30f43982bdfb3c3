#include "constraints/methods/observations.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

Observations of(int rows, double value) {
  Observations data;
  data.q = Eigen::MatrixXd::Constant(rows, 2, value);
  data.set.assign(static_cast<size_t>(rows), 0);
  data.group.assign(static_cast<size_t>(rows), -1);
  data.check.assign(static_cast<size_t>(rows), 0);
  return data;
}

TEST(Joined, HasEveryColumnOfEitherForAllRows) {
  Observations a = of(2, 0.1), b = of(3, 0.2);
  a.time = Eigen::VectorXd::LinSpaced(2, 0, 1);
  a.repeat = {4, 4};
  b.noise_factor = Eigen::VectorXd::Constant(3, 2);
  b.wrench = Eigen::MatrixXd::Constant(3, 6, 7);
  b.velocity = Eigen::MatrixXd::Constant(3, 2, -1);
  const Observations all = joined(a, b);
  EXPECT_EQ(all.rows(), 5);
  EXPECT_EQ(all.q.col(1), (Eigen::VectorXd(5) << 0.1, 0.1, 0.2, 0.2, 0.2).finished());
  ASSERT_EQ(all.time.size(), 5);
  EXPECT_EQ(all.time[1], 1);
  EXPECT_TRUE(all.time.tail(3).array().isNaN().all());
  ASSERT_EQ(all.wrench.rows(), 5);
  EXPECT_TRUE(all.wrench.topRows(2).array().isNaN().all());
  EXPECT_EQ(all.wrench(4, 5), 7);
  EXPECT_EQ(all.velocity.rows(), 5);
  EXPECT_EQ(all.noise_factor, (Eigen::VectorXd(5) << 1, 1, 2, 2, 2).finished());
  EXPECT_EQ(all.repeat, (std::vector<int>{4, 4, -1, -1, -1}));
  EXPECT_EQ(all.set.size(), 5U);
  EXPECT_EQ(all.check.size(), 5U);
}

TEST(Joined, LacksWhatBothLack) {
  const Observations all = joined(of(2, 0), of(1, 0));
  EXPECT_EQ(all.time.size(), 0);
  EXPECT_EQ(all.temperature.size(), 0);
  EXPECT_EQ(all.position.rows(), 0);
  EXPECT_TRUE(all.repeat.empty());
}

TEST(Configurations, AreNumberedInTimeWithTheirRepeatsBySet) {
  Observations rows = of(6, 0);
  rows.set = {0, 0, 1, 1, 0, 0};
  rows.repeat = {7, -1, 7, 7, 7, -1};
  EXPECT_EQ(configurations(rows), (std::vector<int>{0, 1, 2, 2, 0, 3}));
  rows.time = (Eigen::VectorXd(6) << 50, 40, 30, 20, 10, 0).finished();
  EXPECT_EQ(in_time(rows), (std::vector<int>{5, 4, 3, 2, 1, 0}));
  EXPECT_EQ(configurations(rows), (std::vector<int>{1, 3, 2, 2, 1, 0}));
  rows.time[2] = NAN;
  EXPECT_EQ(in_time(rows), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace selfcal
