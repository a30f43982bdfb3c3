#include "diagnosis/evidence/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace selfcal {
namespace {

TEST(WeighedRows, AreOneOfSoManyConfigurationsWithAllItsRepeats) {
  Observations rows;
  rows.q.setZero(8, 1);
  rows.check = {0, 0, 0, 1, 0, 0, 0, 0};
  rows.set.assign(8, 0);
  rows.repeat = {5, 5, -1, -1, -1, 6, 6, -1};
  // Five configurations that judge nothing; one of the first two, of the next two, the last.
  EXPECT_EQ(weighed_rows(rows, 8, 4), (std::vector<char>{1, 1, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(weighed_rows(rows, 8, 8), (std::vector<char>{1, 1, 1, 0, 1, 1, 1, 1}));
}

TEST(WeighedRows, DoNotKeepStepWithHowASessionAlternates) {
  for (const int period : {2, 3, 4, 5}) {
    Observations rows;
    rows.q.setZero(1200, 1);
    rows.check.assign(1200, 0);
    for (const double step : {2.0, 3.0, 4.0, 4.5, 6.0}) {
      const std::vector<char> take = weighed_rows(rows, 1200, 1200 / step);
      std::vector<int> of_kind(static_cast<size_t>(period), 0);
      for (size_t row = 0; row < take.size(); ++row) of_kind[row % period] += take[row];
      EXPECT_NEAR(std::accumulate(of_kind.begin(), of_kind.end(), 0), 1200 / step, 1);
      for (const int count : of_kind)
        EXPECT_NEAR(count, 1200 / step / period, 0.2 * 1200 / step / period + 1)
            << period << " kinds, one of " << step;
    }
  }
}

TEST(UnlikeNoise, IsToldOfMethodsThatTheRowsTellApart) {
  DataSet data;
  Problems problems;
  for (const auto& [name, method] :
       {std::pair("table", "plane"), std::pair("wall", "plane"), std::pair("ball", "sphere")}) {
    Node entry = Node::map();
    entry.set("method", Node::of(std::string(method)));
    data.sets.push_back(make_set(name, entry, problems));
  }
  ASSERT_FALSE(problems.any());
  constexpr int kRows = 300;
  std::vector<int> row(kRows);
  std::iota(row.begin(), row.end(), 0);
  for (const int each : row) data.rows.set.push_back(each % 3);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd noise(kRows), leaves = Eigen::VectorXd::Ones(kRows);
  for (double& each : noise) each = normal(random);
  EXPECT_EQ(unlike_noise(data, row, noise, leaves), std::vector<double>(3, 1.0));

  Eigen::VectorXd unlike = noise;
  for (Eigen::Index i = 2; i < kRows; i += 3) unlike[i] *= 4;
  const std::vector<double> told = unlike_noise(data, row, unlike, leaves);
  EXPECT_EQ(told[0], told[1]);
  // The log of a variance that 100 freedoms tell by the median, to three sigma: 3 (5.4 / 100)^1/2.
  EXPECT_NEAR(std::log(told[2] / told[0]), std::log(16), 0.7);

  // Spheres that their own unknowns meet exactly say nothing of the others' noise.
  for (Eigen::Index i = 2; i < kRows; i += 3) unlike[i] = leaves[i] = 1e-9;
  EXPECT_EQ(unlike_noise(data, row, unlike, leaves), std::vector<double>(3, 1.0));
}

TEST(PooledNoise, IsOneForSetsOfAKindAndTheDataSheetsWhereAllRowsJudge) {
  DataSet data;
  Problems problems;
  for (const char* name : {"left", "right"}) {
    Node entry = Node::map();
    entry.set("method", Node::of(std::string("location")));
    data.sets.push_back(make_set(name, entry, problems));
  }
  Node judging = Node::map();
  judging.set("method", Node::of(std::string("position")));
  judging.set("noise", Node::of(4e-5));
  data.sets.push_back(make_set("judging", judging, problems));
  ASSERT_FALSE(problems.any());
  Fit fitted;
  fitted.rows = {10, 30, 0};
  fitted.noise.estimated = {{1e-3, 3e-3}, {2e-3, 1e-3}, {1, 1}};
  const std::vector<Scale> noise = pooled_noise(data, fitted);
  for (const int set : {0, 1}) {
    EXPECT_NEAR(noise[set].length, 1e-3 * std::sqrt((10 * 1 + 30 * 4) / 40.0), 1e-12) << set;
    EXPECT_NEAR(noise[set].angle, 1e-3 * std::sqrt((10 * 9 + 30 * 1) / 40.0), 1e-12) << set;
  }
  EXPECT_EQ(noise[2].length, 4e-5);
}

TEST(Kept, HoldsWhatNoRowCarries) {
  DenseEquations all;
  all.W = Eigen::MatrixXd::Identity(3, 3);
  all.y = Eigen::Vector3d(1, 2, 3);
  all.shift.setZero(3, 3);
  all.row = {0, 1, -1};
  const DenseEquations some = kept(all, {0, 1});
  EXPECT_EQ(some.row, (std::vector<int>{1, -1}));
  EXPECT_EQ(some.y, Eigen::Vector2d(2, 3));
  EXPECT_EQ(some.W(1, 2), 1);
}

}  // namespace
}  // namespace selfcal
