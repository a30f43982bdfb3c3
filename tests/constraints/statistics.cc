// Distributions against published tables, the signed-rank test against enumeration.
#include "constraints/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace selfcal {
namespace {

TEST(ChiQuantile, IsTheRootOfThePublishedChiSquareQuantile) {
  struct Published {
    int freedom;
    double probability, chi_square;
  };
  // Any table of chi-square, with three or four decimals: half a unit of the third.
  for (const Published& p : {Published{1, 0.95, 3.8415},
                             {1, 0.99, 6.6349},
                             {2, 0.99, 9.2103},
                             {3, 0.99, 11.3449},
                             {6, 0.99, 16.8119},
                             {10, 0.95, 18.307}})
    EXPECT_NEAR(std::pow(chi_quantile(p.freedom, p.probability), 2), p.chi_square, 5e-4);
}

TEST(ChiQuantile, DoesNotMixUpWhatItWasAskedBefore) {
  const double one = chi_quantile(1, 0.99), nine = chi_quantile(9, 0.99),
               half = chi_quantile(1, 0.5);
  EXPECT_EQ(chi_quantile(1, 0.99), one);
  EXPECT_EQ(chi_quantile(9, 0.99), nine);
  EXPECT_EQ(chi_quantile(1, 0.5), half);
  EXPECT_NEAR(half, 0.67449, 1e-5);  // quartile of the normal distribution
}

TEST(ChiSquareExceeds, IsThePublishedLevelAtThePublishedQuantile) {
  EXPECT_NEAR(chi_square_exceeds(3.8415, 1), 0.05, 1e-5);  // four decimals of the quantile
  EXPECT_NEAR(chi_square_exceeds(18.307, 10), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_exceeds(2 * 3.0, 2), std::exp(-3.0), 1e-12);  // exponential
  EXPECT_EQ(chi_square_exceeds(5, 0), 1);
}

TEST(Statistics, KnowTheLogarithmOfAProbabilityTooSmallForANumber) {
  EXPECT_NEAR(log_chi_square_below(3.8415, 1), std::log(0.95), 1e-5);
  // Of four freedoms: 1 - (1 + x / 2) exp(-x / 2).
  EXPECT_NEAR(log_chi_square_below(6, 4), std::log(1 - 4 * std::exp(-3.0)), 1e-12);
  // With 400 degrees of freedom and hardly a square the series has one term: x^a e^-x / a!, where
  // ln 200! = 863.2319871924 (Abramowitz and Stegun, table 6.4 continued by Stirling's series).
  EXPECT_NEAR(log_chi_square_below(2e-9, 400), 200 * std::log(1e-9) - 863.2319871924, 1e-6);
  // Far below its mean the series begins with (x / 2)^(k / 2) exp(-x / 2) / Gamma(k / 2 + 1), and
  // goes on by x / (k + 2), of which the next would be 3e-7 here.
  const double x = 1, k = 1800;
  EXPECT_NEAR(log_chi_square_below(x, k),
              k / 2 * std::log(x / 2) - x / 2 - std::lgamma(k / 2 + 1) + x / (k + 2), 1e-6);
}

TEST(StudentBelow, IsThePublishedLevelAtThePublishedQuantile) {
  EXPECT_NEAR(student_below(2.2281, 10), 0.975, 1e-5);
  EXPECT_NEAR(student_below(-2.6349, 91), 0.005, 1e-4);
  EXPECT_NEAR(student_below(3, 1), 0.5 + std::atan(3) / std::numbers::pi, 1e-12);
}

TEST(FExceeds, IsThePublishedLevelAtThePublishedQuantile) {
  EXPECT_NEAR(f_exceeds(3.3258, 5, 10), 0.05, 1e-5);
  EXPECT_NEAR(f_exceeds(10.0443, 1, 10), 0.01, 1e-5);
  EXPECT_NEAR(f_exceeds(161.4476, 1, 1), 0.05, 1e-6);
}

TEST(Statistics, SayNothingOfWhatIsNoNumber) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                   kInfinite = std::numeric_limits<double>::infinity();
  for (const double none : {kNone, -1.0, 0.0}) {
    EXPECT_EQ(f_exceeds(none, 3, 4), 1);
    EXPECT_EQ(f_exceeds(2, none, 4), 1);
    EXPECT_EQ(f_exceeds(2, 3, none), 1);
    EXPECT_EQ(chi_square_exceeds(none, 4), 1);
    EXPECT_EQ(chi_square_exceeds(2, none), 1);
    EXPECT_EQ(student_below(2, none), 0.5);
    EXPECT_EQ(student_quantile(0.9, none), student_quantile(0.9, 1));
  }
  EXPECT_EQ(student_below(kNone, 4), 0.5);
  EXPECT_EQ(signed_rank_p({kNone, 1, -2, kNone, 3}), signed_rank_p({1, -2, 3}));
  EXPECT_EQ(f_exceeds(kInfinite, 3, 4), 0);
  EXPECT_EQ(chi_square_exceeds(kInfinite, 4), 0);
  // Of many lower freedoms F is chi-square over its own.
  EXPECT_NEAR(f_exceeds(18.307 / 10, 10, kInfinite), 0.05, 1e-5);
}

/// Differences 1 to n, positive so that their ranks add up to `sum`.
std::vector<double> differences(int n, int sum) {
  std::vector<double> d;
  for (int rank = n; rank >= 1; --rank) {
    const bool positive = rank <= sum;
    if (positive) sum -= rank;
    d.push_back(positive ? rank : -rank);
  }
  return d;
}

TEST(SignedRank, OfFiveDifferencesIsTheShareOfSignsThatReachTheSum) {
  for (int sum = 0; sum <= 15; ++sum) {
    int reached = 0;
    for (int signs = 0; signs < 32; ++signs) {
      int positive = 0;
      for (int rank = 1; rank <= 5; ++rank)
        if (signs & (1 << (rank - 1))) positive += rank;
      if (positive >= sum) ++reached;
    }
    EXPECT_DOUBLE_EQ(signed_rank_p(differences(5, sum)), reached / 32.0) << sum;
  }
}

TEST(SignedRank, HasThePublishedCriticalValues) {
  EXPECT_DOUBLE_EQ(signed_rank_p(differences(10, 45)), 43.0 / 1024);  // 0.042
  EXPECT_NEAR(signed_rank_p(differences(15, 90)), 0.0473, 5e-5);      // tables of four decimals
  EXPECT_NEAR(signed_rank_p(differences(20, 150)), 0.0487, 5e-5);
}

TEST(SignedRank, LooksAtRanksOnlyAndDropsZeros) {
  EXPECT_DOUBLE_EQ(signed_rank_p({1e-9, 0, 5, -3, 0, 1e6, 7, 0}), signed_rank_p({1, 3, -2, 5, 4}));
}

TEST(SignedRank, OfManyDifferencesWithTiesIsNearTheExactOne) {
  // Magnitudes 1 and 2, both positive, replaced by two 1.5: the same sum, but by the approximation.
  // It leaves out the Edgeworth series' next term, 3.6 / n / 24 |z^3 - 3 z| phi(z) < 1.7e-3 at n
  // = 50.
  for (const int sum : {500, 640, 738, 810, 900}) {
    std::vector<double> d = differences(50, sum);
    d[48] = 2;
    d[49] = 1;
    const double exact = signed_rank_p(d);
    d[48] = d[49] = 1.5;
    EXPECT_NEAR(signed_rank_p(d), exact, 2e-3) << sum;
    EXPECT_NE(signed_rank_p(d), exact);
  }
}

TEST(SignedRank, JoinsItsApproximationWithoutAStep) {
  // 50 differences are exact, 51 are not: the same sum in sigmas, rounded to a whole one, which
  // moves p by at most 0.005 sigma x phi(1.67); the series' next term is 3e-4 there.
  const double z = (810 - 637.5) / std::sqrt(50 * 51 * 101 / 24.0);
  const int sum = static_cast<int>(std::lround(663 + z * std::sqrt(51 * 52 * 103 / 24.0)));
  EXPECT_NEAR(signed_rank_p(differences(51, sum)), signed_rank_p(differences(50, 810)), 1e-3);
}

TEST(SignedRank, OfNothingSaysNothing) {
  EXPECT_EQ(signed_rank_p({}), 1);
  EXPECT_EQ(signed_rank_p({0, 0}), 1);
}

TEST(SignedRank, IsOneHalfOrMoreForASymmetricSampleAndSmallForPositiveOnes) {
  EXPECT_GT(signed_rank_p({1, -1, 2, -2, 3, -3}), 0.5);
  EXPECT_DOUBLE_EQ(signed_rank_p(differences(20, 210)), std::pow(0.5, 20));
}

TEST(EffectiveFreedoms, AreThoseOfWelchAndSatterthwaite) {
  EXPECT_DOUBLE_EQ(effective_freedoms({{2, 7}}), 7);
  EXPECT_DOUBLE_EQ(effective_freedoms({{1, 10}, {1, 10}}), 20);
  EXPECT_DOUBLE_EQ(effective_freedoms({{1, 10}, {3, HUGE_VAL}}), 160) << "4^2 / (1 / 10)";
  EXPECT_TRUE(std::isinf(effective_freedoms({{1, HUGE_VAL}})));
}

TEST(Median, IsTheMiddleOne) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({}), 0);
}

TEST(AsManyDrawn, CountsTheDrawsWithoutReplacement) {
  // Of 60, ten of which have it, five: 252 of 5 461 512 draws have five of these.
  EXPECT_NEAR(as_many_drawn(5, 5, 10, 60), 252 / 5461512.0, 1e-12);
  // Of four, two of which have it, two: one of six draws has both, five have at least one.
  EXPECT_NEAR(as_many_drawn(2, 2, 2, 4), 1 / 6.0, 1e-12);
  EXPECT_NEAR(as_many_drawn(1, 2, 2, 4), 5 / 6.0, 1e-12);
  EXPECT_EQ(as_many_drawn(0, 2, 2, 4), 1);
  EXPECT_EQ(as_many_drawn(1, 3, 2, 4), 1) << "three of four cannot but have one";
}

}  // namespace
}  // namespace selfcal
