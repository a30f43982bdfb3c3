// The line through a figure over time, by hand.
#include "app/report/trend.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

TEST(Trend, IsTheLineThroughPointsOnALine) {
  const auto line = trend({0, 1, 2, 3}, {1, 3, 5, 7}, {1, 1, 1, 1});
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->rate, 2, 1e-12);
  EXPECT_NEAR(line->value(10), 21, 1e-12);
  // S_tt = 2.25 + 0.25 + 0.25 + 2.25 = 5, of sigmas of 1.
  EXPECT_NEAR(line->rate_sigma, 1 / std::sqrt(5.0), 1e-12);
}

TEST(Trend, TakesTheScatterForSigmaWhereItIsMore) {
  // Residuals about the level line 0: 1, -2, 1; chi2 = 6 of one freedom, S_tt = 2.
  const auto line = trend({0, 1, 2}, {1, -2, 1}, {1, 1, 1});
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->rate, 0, 1e-12);
  EXPECT_NEAR(line->rate_sigma, std::sqrt(6.0 / 2), 1e-12);
}

TEST(Trend, NeedsThreePointsThatDifferInTime) {
  EXPECT_FALSE(trend({0, 1}, {0, 1}, {1, 1}));
  EXPECT_FALSE(trend({5, 5, 5}, {0, 1, 2}, {1, 1, 1}));
}

TEST(Trend, TellsWhenALimitWillBeLeft) {
  const auto line = trend({0, 1, 2, 3}, {1, 3, 5, 7}, {0.1, 0.1, 0.1, 0.1});
  EXPECT_NEAR(leaves_at(*line, 3, -20, 20).value(), 9.5, 1e-9);
  EXPECT_FALSE(leaves_at(*line, 3, -5, 5));  // outside already
  const auto unsure = trend({0, 1, 2, 3}, {1, 3, 5, 7}, {9, 9, 9, 9});
  EXPECT_FALSE(leaves_at(*unsure, 3, -20, 20));
}

}  // namespace
}  // namespace selfcal
