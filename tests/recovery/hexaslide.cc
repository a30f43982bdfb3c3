// The Hexa Slide with the constraint link: Tables 1 to 3 of Rauf, Kim and Ryu, Calibration of
// parallel manipulators using a new measurement device. Table 3 is of a few robots by default, of
// SELFCAL_SEEDS on demand (README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "tests/recovery/hexaslide_device.h"
#include "tests/recovery/rx90.h"
#include "tests/support/cell.h"

namespace selfcal::recovery {
namespace {

double middle(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

TEST(Hexaslide, IsToldWholeByTheConstraintLink) {
  Random random(1);
  const auto exact = slider(kNone, random);
  Problems problems;
  std::vector<Set> sets = {
      make_set("s", entry({{"method", "constraint-link"}, {"length", "0.75"}}), problems)};
  const StructuralRank told = structural(*exact, sets, std::vector<char>(54, 1), 120, 1);
  EXPECT_EQ(told.unreached, "");
  EXPECT_EQ(told.rank.total(), 54);
}

TEST(Hexaslide, TellsOfADevicesAngleThatCountsTheOtherWay) {
  Random random(3);
  const auto nominal = slider(kTable2[0], random);
  DataSet data = device_rows(120, 5e-6, random);
  add_noise(5e-6, random, data.rows);
  data.rows.measured["phi"] *= -1;
  const Solution solution = identify(*nominal, data);
  EXPECT_NE(solution.verdict.answer, Answer::improved) << solution.verdict.why;
  EXPECT_THAT(solution.warnings,
              testing::Contains(testing::HasSubstr("check the signs and zeros of the readings")));
}

TEST(Hexaslide, HasNominalSetsOfThePublishedStatistics) {
  for (const NominalErrors& set : kTable2) {
    Random random(4);
    const std::vector<double> errors = drawn_errors(set, random);
    double most = 0, sum = 0, squares = 0, signed_sum = 0;
    for (const double each : errors) {
      most = std::max(most, std::abs(each));
      sum += std::abs(each) / 54;
      squares += each * each / 54;
      signed_sum += each / 54;
    }
    EXPECT_EQ(most, set.most);
    EXPECT_NEAR(sum, set.mean, 0.02 * set.mean);
    EXPECT_NEAR(std::sqrt(squares), set.sigma, 0.02 * set.sigma);
    EXPECT_LT(std::abs(signed_sum), 4 * set.sigma / std::sqrt(54));  // either sign alike, 4 sigma
  }
}

TEST(Hexaslide, IsFoundToRoundingFromAllThreeNominalSetsByThirtyExactPostures) {
  for (const NominalErrors& set : kTable2) {
    Random random(2);
    const auto exact = slider(kNone, random);
    const auto nominal = slider(set, random);
    DataSet data = device_rows(400, 0, random);
    const Objective judge = by_end_position(*nominal, random);
    data.rows =
        taken(data.rows, best_rows(*nominal, data, 30, ChosenBy::condition, judge, random).rows);
    Options options;
    options.priors = false;
    const Solution solution = identify(*nominal, data, options);
    EXPECT_TRUE(solution.converged) << solution.stop_reason;
    const double left = (solution.values - values(*exact)).cwiseAbs().maxCoeff();
    std::printf("off by up to %.1f mm: %.1e m left, condition %.0f\n", 1e3 * set.most, left,
                solution.observability.condition);
    EXPECT_LT(left, 1e-11);  // rounding of 1e-16 m, magnified by a condition of some thousands
  }
}

TEST(Hexaslide, IsFoundThoughAPostureAtTheEdgeOfItsReachDoesNotCloseOnTheWay) {
  constexpr double kNoise = 50e-6;
  Random random(46);
  const auto exact = slider(kNone, random);
  const auto nominal = slider(kTable2[1], random);
  DataSet data = device_rows(600, kNoise / std::sqrt(3.0), random);
  const Objective judge = by_end_position(*nominal, random);
  data.rows =
      taken(data.rows, best_rows(*nominal, data, 60, ChosenBy::condition, judge, random).rows);
  add_noise(kNoise, random, data.rows);
  const Solution solution = identify(*nominal, data);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_LT(posture_error(*exact, solution.values).position, 2 * kNoise);
}

/// What calibrations of many sliders under noise come to.
struct UnderNoise {
  int robots = 0;
  double expected = 0;                   ///< m, median of the choices' end-position sigmas
  double position = 0, degrees = 0;      ///< medians of the mean posture errors (m)
  double within_one = 0, within_95 = 0;  ///< shares of all parameters that are within their sigmas
};

UnderNoise calibrated_under_noise(double noise, ChosenBy by) {
  UnderNoise result;
  result.robots = repetitions("SELFCAL_SEEDS", 3);
  double one = 0, most = 0, all = 0;
  std::vector<double> positions, turns, expected;
  const int first = repetitions("SELFCAL_FIRST_SEED", 1);
  for (int seed = first; seed < first + result.robots; ++seed) {
    Random random(seed);
    const auto exact = slider(kNone, random);
    const auto nominal = slider(kTable2[1], random);
    DataSet data = device_rows(600, noise / std::sqrt(3.0), random);
    const Objective judge = by_end_position(*nominal, random);
    const Choice choice = best_rows(*nominal, data, 60, by, judge, random);
    expected.push_back(choice.expected);
    data.rows = taken(data.rows, choice.rows);
    add_noise(noise, random, data.rows);
    const Solution solution = identify(*nominal, data);
    EXPECT_TRUE(solution.converged) << seed << " " << solution.stop_reason;
    for (Eigen::Index i = 0; i < solution.values.size(); ++i) {
      const double sigma = solution.parameters[static_cast<size_t>(i)].sigma;
      const double z = std::abs(solution.values[i] - values(*exact)[i]) / sigma;
      one += z < 1;
      most += z < 1.96;
      ++all;
    }
    const PostureError error = posture_error(*exact, solution.values);
    positions.push_back(error.position);
    turns.push_back(180 / std::numbers::pi * error.turn);
  }
  result.position = middle(positions);
  result.degrees = middle(turns);
  result.expected = middle(expected);
  result.within_one = one / all;
  result.within_95 = most / all;
  std::printf("| %.0f | %s | %d | %.1f | %.1f | %.4f | %.1f | %.1f |\n", 1e6 * noise,
              by == ChosenBy::chance      ? "chance"
              : by == ChosenBy::condition ? "condition"
                                          : "end position",
              result.robots, 1e6 * result.expected, 1e6 * result.position, result.degrees,
              100 * result.within_one, 100 * result.within_95);
  return result;
}

/// Table 3.
struct Published {
  double noise, position, degrees;
};

class HexaslideUnderNoise : public testing::TestWithParam<Published> {};

TEST_P(HexaslideUnderNoise, IsKnownAsWellAsPublishedAndBetterByPosturesChosenForTheEndPosition) {
  const Published& row = GetParam();
  const UnderNoise any = calibrated_under_noise(row.noise, ChosenBy::chance);
  const UnderNoise as_there = calibrated_under_noise(row.noise, ChosenBy::condition);
  const UnderNoise better = calibrated_under_noise(row.noise, ChosenBy::end_position);
  for (const UnderNoise* each : {&as_there, &better}) {
    EXPECT_LE(each->position, row.position);
    EXPECT_LE(each->degrees, row.degrees);
  }
  EXPECT_LT(better.expected, as_there.expected);
  EXPECT_LT(better.expected, any.expected);
  for (const UnderNoise* each : {&any, &as_there, &better}) {
    // Ten independent parameters of a robot, three sigma of each share.
    EXPECT_NEAR(each->within_one, 0.683, 3 * std::sqrt(0.683 * 0.317 / (10 * each->robots)));
    EXPECT_NEAR(each->within_95, 0.95, 3 * std::sqrt(0.95 * 0.05 / (10 * each->robots)));
  }
  if (any.robots < 50) return;  // medians of few scatter by more than the gain
  EXPECT_LT(better.position, as_there.position);
  EXPECT_LT(better.position, any.position);
}

INSTANTIATE_TEST_SUITE_P(Table3, HexaslideUnderNoise,
                         testing::Values(Published{5e-6, 19.6e-6, 0.004},
                                         Published{10e-6, 32e-6, 0.005},
                                         Published{50e-6, 169e-6, 0.045}),
                         [](const auto& made) {
                           return "Noise" + std::to_string(std::lround(1e6 * made.param.noise));
                         });

}  // namespace
}  // namespace selfcal::recovery
