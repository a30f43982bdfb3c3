#include "diagnosis/search/sign_flip_test.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

TEST(LeastProbabilityOfNone, IsThatOfThePublishedTable) {
  // Sellke, Bayarri and Berger, The American Statistician 55 (2001), table 1.
  EXPECT_NEAR(least_probability_of_none(0.1), 0.385, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.05), 0.289, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.01), 0.111, 5e-4);
  EXPECT_NEAR(least_probability_of_none(0.001), 0.0184, 5e-5);
  EXPECT_EQ(least_probability_of_none(0.5), 0.5);
}

TEST(NullDistribution, CountsWhatIsAsGoodAndTheRowsThemselves) {
  const NullDistribution null({0.5, 3, 1, 2});
  EXPECT_EQ(null.p_of(4), 1.0 / 5);
  EXPECT_EQ(null.p_of(3), 2.0 / 5);
  EXPECT_EQ(null.p_of(0), 1);
}

}  // namespace
}  // namespace selfcal
