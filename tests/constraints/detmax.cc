// The exchange algorithm against determinants computed as they are defined.
#include "constraints/planning/detmax.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>

#include "tests/support/full_detmax.h"

namespace selfcal {
namespace {

std::vector<Eigen::MatrixXd> random_candidates(int count, int k, int m, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::MatrixXd> candidates(count, Eigen::MatrixXd(k, m));
  for (Eigen::MatrixXd& w : candidates)
    for (Eigen::Index c = 0; c < m; ++c)  // columns of very different units
      for (Eigen::Index r = 0; r < k; ++r) w(r, c) = normal(random) * std::pow(10.0, c % 5 - 2);
  return candidates;
}

TEST(Detmax, StopsWhereNoExchangeOfTheBestAddedForTheWorstRemovedIsLeft) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 10; ++i) {
    const auto candidates = random_candidates(60, 3, 9, random);
    const Exchange found = detmax(candidates, 12, random);
    ASSERT_EQ(found.chosen.size(), 12u);
    EXPECT_TRUE(std::is_sorted(found.chosen.begin(), found.chosen.end()));
    EXPECT_EQ(std::adjacent_find(found.chosen.begin(), found.chosen.end()), found.chosen.end());
    EXPECT_NEAR(found.o1, o1_of(candidates, found.chosen), 1e-12 * found.o1);
    // By the definition: O1 of every set with one more, then of every one with one less of that.
    std::vector<int> more;
    double best = 0;
    for (int c = 0; c < 60; ++c) {
      if (std::binary_search(found.chosen.begin(), found.chosen.end(), c)) continue;
      std::vector<int> with = found.chosen;
      with.push_back(c);
      if (const double o1 = o1_of(candidates, with); o1 > best) {
        best = o1;
        more = with;
      }
    }
    for (size_t out = 0; out < more.size(); ++out) {
      std::vector<int> less = more;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(out));
      EXPECT_LE(o1_of(candidates, less), found.o1 * (1 + 1e-9));
    }
  }
}

TEST(Detmax, SeesMoreThanAnyOfAHundredRandomChoices) {
  std::mt19937_64 random(6);
  const auto candidates = random_candidates(200, 1, 8, random);
  const Exchange found = detmax(candidates, 20, random);
  EXPECT_GT(found.exchanges, 5);
  std::vector<int> order(200);
  std::iota(order.begin(), order.end(), 0);
  for (int i = 0; i < 100; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    EXPECT_GT(found.o1, o1_of(candidates, {order.begin(), order.begin() + 20}));
  }
}

TEST(Detmax, FindsItsWayOutOfAStartThatDoesNotSeeEverything) {
  // Two candidates of 300 alone see the last parameter: hardly any start of ten has one.
  std::mt19937_64 random(7);
  for (int i = 0; i < 10; ++i) {
    auto candidates = random_candidates(300, 1, 6, random);
    for (int c = 0; c < 300; ++c)
      if (c != 17 && c != 170) candidates[c](0, 5) = 0;
    const Exchange found = detmax(candidates, 10, random);
    EXPECT_THAT(found.chosen, testing::AnyOf(testing::Contains(17), testing::Contains(170)));
    EXPECT_GT(found.o1, 0);
  }
}

TEST(Detmax, EndsWhereFewMeasurementsLeaveMostToThePrior) {
  // A metre of prior against 20 um of noise: each change rounds, and the rounding of some adds up
  // to more than the best exchange gains.
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    std::vector<Eigen::MatrixXd> candidates(400, Eigen::MatrixXd(1, 36));
    for (Eigen::MatrixXd& w : candidates)
      w = Eigen::MatrixXd::NullaryExpr(1, 36, [&] { return normal(random) / 2e-5; });
    Objective objective;
    objective.criterion = Criterion::sigma;
    Eigen::VectorXd variance = Eigen::VectorXd::Constant(36, 1e-6);
    variance.tail(12).setOnes();
    objective.prior = variance.cwiseInverse().asDiagonal();
    objective.weight = Eigen::MatrixXd::Zero(36, 36);
    objective.weight.topLeftCorner(24, 24).setIdentity();
    objective.nuisance = 12;
    Design design(candidates, objective);
    design.choose(random_choice(400, 15, random));
    const double before = design.merit();
    exchange(design);
    const double after = design.merit();
    design.choose(design.chosen());
    EXPECT_GT(after, before);
    EXPECT_NEAR(after, design.merit(), 1e-6 * std::abs(after)) << "as the choice made anew has it";
    EXPECT_EQ(design.chosen().size(), 15U);
  }
}

TEST(Detmax, TakesAllWhereAllAreAskedFor) {
  std::mt19937_64 random(8);
  const auto candidates = random_candidates(5, 2, 4, random);
  const Exchange found = detmax(candidates, 5, random);
  EXPECT_THAT(found.chosen, testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(found.exchanges, 0);
}

TEST(Detmax, IsAsGoodAsWithFullDecompositionsFromTheSameStart) {
  std::mt19937_64 random(9);
  for (int i = 0; i < 5; ++i) {
    const auto candidates = random_candidates(50, 3, 6, random);
    const std::vector<int> start = random_choice(50, 8, random);
    Design design(candidates, {});
    design.choose(start);
    exchange(design);
    const FullSearch full = by_full_decompositions(candidates, start, 1000);
    EXPECT_GE(o1_of(candidates, design.chosen()), o1_of(candidates, full.chosen) * (1 - 1e-9));
  }
}

TEST(Detmax, IsHundredsOfTimesFasterThanFullDecompositionsOf50Of875With32Parameters) {
  std::mt19937_64 random(10);
  const auto candidates = random_candidates(875, 3, 32, random);
  const std::vector<int> start = random_choice(875, 50, random);
  const std::clock_t begin = std::clock();
  constexpr int kTimes = 5;
  int exchanges = 0;
  for (int i = 0; i < kTimes; ++i) {
    Design design(candidates, {});
    design.choose(start);
    exchanges = add_and_drop(design);
  }
  const double seconds =
      static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kTimes / exchanges;
  // One exchange of the same start stands for all: each asks for as many decompositions.
  const FullSearch full = by_full_decompositions(candidates, start, 1);
  ASSERT_EQ(full.exchanges, 1);
  RecordProperty("times_faster", static_cast<int>(full.seconds / seconds));
  EXPECT_GT(full.seconds / seconds, 100) << "of about 800";
}

}  // namespace
}  // namespace selfcal
