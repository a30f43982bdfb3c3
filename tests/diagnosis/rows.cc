#include "diagnosis/evidence/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

/// Three sets, and rows dealt out to them by `set_of`.
DataSet three_sets(const std::array<const char*, 3>& methods, int rows,
                   const std::function<int(int)>& set_of) {
  DataSet data;
  Problems problems;
  for (int s = 0; s < 3; ++s) {
    Node entry = Node::map();
    entry.set("method", Node::of(std::string(methods[s])));
    data.sets.push_back(make_set("set" + std::to_string(s), entry, problems));
  }
  EXPECT_FALSE(problems.any());
  for (int row = 0; row < rows; ++row) data.rows.set.push_back(set_of(row));
  return data;
}

bool are_alike(const std::vector<Scale>& noise) {
  return std::ranges::all_of(noise,
                             [](const Scale& each) { return each.length == 1 && each.angle == 1; });
}

class UnlikeNoise : public testing::Test {
 protected:
  static constexpr int kRows = 300;
  UnlikeNoise() {
    rows.row.resize(kRows);
    std::iota(rows.row.begin(), rows.row.end(), 0);
    rows.quantity.assign(kRows, Quantity::length);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (double& each : noise) each = normal(random);
  }

  DenseEquations rows;
  std::vector<Scale> none = std::vector<Scale>(3, Scale{0, 0});
  Eigen::VectorXd noise{kRows}, leaves = Eigen::VectorXd::Ones(kRows);
};

TEST_F(UnlikeNoise, IsToldOfSetsThatTheRowsTellApart) {
  for (const char* method : {"sphere", "plane"}) {
    const DataSet data =
        three_sets({"plane", "plane", method}, kRows, [](int each) { return each % 3; });
    EXPECT_TRUE(are_alike(unlike_noise(data, rows, noise, leaves, none)));

    Eigen::VectorXd unlike = noise;
    for (Eigen::Index i = 2; i < kRows; i += 3) unlike[i] *= 4;
    const std::vector<Scale> told = unlike_noise(data, rows, unlike, leaves, none);
    // The log of a sigma that 100 freedoms tell by the median, to three sigma: 3/2 (5.4/100)^1/2.
    EXPECT_NEAR(std::log(told[2].length / told[0].length), std::log(4), 0.35) << method;
    EXPECT_NEAR(std::log(told[1].length / told[0].length), 0, 0.35) << method;

    // Sets that their own unknowns meet exactly say nothing of the others' noise.
    Eigen::VectorXd leave = leaves;
    for (Eigen::Index i = 2; i < kRows; i += 3) unlike[i] = leave[i] = 1e-9;
    EXPECT_TRUE(are_alike(unlike_noise(data, rows, unlike, leave, none))) << method;
  }
}

TEST_F(UnlikeNoise, IsOneForSetsOfFewRows) {
  const DataSet data = three_sets({"plane", "plane", "plane"}, kRows,
                                  [](int each) { return each < 30 ? each % 2 : 2; });
  noise.head(30) *= 4;
  const std::vector<Scale> told = unlike_noise(data, rows, noise, leaves, none);
  EXPECT_EQ(told[0].length, told[1].length);
  EXPECT_GT(told[0].length, 2 * told[2].length);
}

TEST_F(UnlikeNoise, IsToldOfAnglesBesideTheLengthsOfTheSameRows) {
  const DataSet data =
      three_sets({"location", "location", "location"}, kRows, [](int each) { return each / 50; });
  for (int i = 0; i < kRows; ++i) {
    rows.row[static_cast<size_t>(i)] = i / 2;
    if (i % 2 == 0) rows.quantity[static_cast<size_t>(i)] = Quantity::angle;
  }
  EXPECT_TRUE(are_alike(unlike_noise(data, rows, noise, leaves, none)));
  for (Eigen::Index i = 0; i < kRows; i += 2) noise[i] /= 4;
  for (const Scale& each : unlike_noise(data, rows, noise, leaves, none))
    EXPECT_NEAR(std::log(each.length / each.angle), std::log(4), 0.5);
  // Data sheets that say that the angles are as noisy.
  EXPECT_TRUE(are_alike(unlike_noise(data, rows, noise, leaves, std::vector<Scale>(3, {1, 1}))));
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
  all.quantity = {Quantity::length, Quantity::angle, Quantity::length};
  const DenseEquations some = kept(all, {0, 1});
  EXPECT_EQ(some.row, (std::vector<int>{1, -1}));
  EXPECT_EQ(some.y, Eigen::Vector2d(2, 3));
  EXPECT_EQ(some.W(1, 2), 1);
  EXPECT_EQ(some.quantity, (std::vector{Quantity::angle, Quantity::length}));
}

}  // namespace
}  // namespace selfcal
