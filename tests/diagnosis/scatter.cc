// Rows that scatter more than their files state, by hand and through a diagnosis.
#include "diagnosis/report/scatter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;

// Twice the stated noise, known by many rows: ln 2 is 4.621 times 0.15, where the density of
// Student's variable of five freedoms is 0.3796 (1 + 4.621^2 / 5)^-3 / 0.15 = 0.01728; of the
// unknown's size, 0.1 * 4 / 3 / ln 64 = 0.03206. Odds of 1.855.
TEST(Scatter, IsTheUnknownsByHowFarAStatedNoiseMayBeOff) {
  const double many = 1e9;
  EXPECT_NEAR(unknown_by_scatter({.declared = 1e-4, .found = 2e-4}, many), 1.855 / 2.855, 1e-3);
  EXPECT_EQ(unknown_by_scatter({.declared = 1e-4, .found = 0.9e-4}, many), 0);
  for (const double found : {1.001e-4, 1.03e-4, 1.04e-4, 1.1e-4, 1.2e-4, 1.4e-4})
    EXPECT_LT(unknown_by_scatter({.declared = 1e-4, .found = found}, many), 0.2) << found;
  EXPECT_GT(unknown_by_scatter({.declared = 1e-4, .found = 4e-4}, many), 0.95);
  EXPECT_LT(unknown_by_scatter({.declared = 1e-4, .found = 2e-4}, 10), 0.4) << "of few rows";
  // Ten freedoms of repeats, by 0.38 mm: 10 / 2 ((3.8^2 - 3.8^2 / 16) - ln 16) = 53.8; by 0.1 mm:
  // 10 / 2 ((1 - 1 / 16) - ln 16) = -9.18.
  Scatter repeated{.declared = 1e-4, .found = 4e-4, .repeats = {10 * 3.8e-4 * 3.8e-4, 10}};
  EXPECT_NEAR(log_confirmed(repeated), 53.82, 0.01);
  EXPECT_LT(unknown_by_scatter(repeated, many), 1e-9) << "the repeats say that it is noise";
  repeated.repeats.squares = 10 * 1e-4 * 1e-4;
  EXPECT_NEAR(log_confirmed(repeated), -9.18, 0.01);
  EXPECT_GT(unknown_by_scatter(repeated, many), 0.999);
}

/// Position rows whose noise is so many times what their file states.
Diagnosis of_rows_that_scatter(double times) {
  TwoSessions sessions;
  Random random(7);
  std::normal_distribution<double> normal(0, std::sqrt(times * times - 1) * kTrackerNoise);
  for (double& each : sessions.before.rows.position.reshaped()) each += normal(random);
  return diagnose(sessions.robot, sessions.before, quick());
}

TEST(Scatter, IsAWarningWhereTheStatedNoiseMayBeOffAndTheVerdictWhereItHardlyIs) {
  const Diagnosis little = of_rows_that_scatter(1.5);
  EXPECT_EQ(little.verdict.effect, kNone);
  EXPECT_THAT(little.warnings, Contains(HasSubstr("state a noise of 0.02 mm")));
  const Diagnosis much = of_rows_that_scatter(3);
  EXPECT_EQ(much.verdict.effect, kUnknown);
  EXPECT_GT(much.verdict.probability, 0.8);
  EXPECT_LT(much.p_value, 1e-3);
  EXPECT_THAT(much.why, HasSubstr("state a noise of 0.02 mm"));
  EXPECT_THAT(much.why, HasSubstr("repeat some configurations at once"));
  for (const CauseResult& each : much.candidates) {
    if (each.effect == kUnknown) {
      EXPECT_EQ(each.probability, much.verdict.probability);
    } else {
      EXPECT_LT(each.probability, 0.2) << each.effect;
    }
  }
}

}  // namespace
}  // namespace selfcal
