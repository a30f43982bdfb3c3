// Sets of hardly more rows than they have unknowns of their own, beside others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kNoise = 2e-5;  // m

DataSet data_of(const std::string& sets, int seed = 3) {
  return made("robot: rx90.robot.yaml\nseed: " + std::to_string(seed) +
              "\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets:\n" + sets)
      .data;
}

/// Of each set, the rows from `fit` on judge.
void keep_aside(DataSet& data, const std::vector<int>& fit) {
  std::vector<int> seen(data.sets.size(), 0);
  for (int row = 0; row < data.rows.rows(); ++row) {
    const auto set = static_cast<std::size_t>(data.rows.set[row]);
    data.rows.check[row] = seen[set]++ >= fit[set];
  }
}

TEST(SmallSets, JudgeNothingWhereAnyRobotMeetsThem) {
  DataSet data = data_of(
      "  tracker: {method: position, rows: 50, noise: 2.0e-5}\n"
      "  a: {method: plane, rows: 3, noise: 2.0e-5}\n"
      "  b: {method: plane, rows: 3, noise: 2.0e-5}\n"
      "  ball: {method: sphere, rows: 4, noise: 2.0e-5}\n");
  keep_aside(data, {40, 0, 0, 0});
  for (const bool repeated : {false, true}) {
    if (repeated) {  // the planes' touches, three times each
      std::vector<int> rows;
      for (int row = 0; row < data.rows.rows(); ++row)
        rows.insert(rows.end(), data.rows.set[row] == 0 ? 1 : 3, row);
      data.rows = taken(data.rows, rows);
      data.rows.repeat = rows;
    }
    const Solution solution = identify(rx90(), data);
    EXPECT_EQ(solution.verdict.answer, Answer::improved) << solution.verdict.why;
    EXPECT_EQ(solution.residual.check.rows, 10) << "the tracker's";
    EXPECT_THAT(solution.warnings,
                Contains(HasSubstr("set a (alike: b and ball): its rows kept aside")));
  }
}

TEST(SmallSets, OfTwoPointsDoNotPlaceAFrame) {
  DataSet data = data_of(
      "  one: {method: position, frame: unknown, rows: 50, noise: 2.0e-5}\n"
      "  two: {method: position, frame: unknown, rows: 8, noise: 2.0e-5}\n");
  keep_aside(data, {40, 2});
  const Solution solution = identify(rx90(), data);
  EXPECT_THAT(solution.warnings,
              Contains(HasSubstr("set two: its rows to identify are too few to place it")));
  EXPECT_LT(solution.residual.check.rms_after, 5 * kNoise);
}

/// The touches of set `set` that are nearest to a line through the first and the one farthest from
/// it; all rows of the others.
DataSet on_a_line(const DataSet& data, int set, std::size_t count) {
  std::vector<int> touches, kept;
  for (int row = 0; row < data.rows.rows(); ++row)
    (data.rows.set[row] == set ? touches : kept).push_back(row);
  const auto at = [&](int row) -> Eigen::Vector3d {
    return locate(rx90(), values(rx90()), data.rows.q.row(row).transpose()).p;
  };
  const Eigen::Vector3d origin = at(touches.front());
  const auto away = [&](int row) { return (at(row) - origin).norm(); };
  const Eigen::Vector3d along =
      (at(*std::ranges::max_element(touches, {}, away)) - origin).normalized();
  std::ranges::sort(touches, {}, [&](int row) { return (at(row) - origin).cross(along).norm(); });
  kept.insert(kept.end(), touches.begin(), touches.begin() + static_cast<std::ptrdiff_t>(count));
  std::ranges::sort(kept);
  DataSet some = data;
  some.rows = taken(data.rows, kept);
  return some;
}

TEST(SmallSets, TouchedOnALineTakeTheirNormalFromThePlaneBesideThem) {
  for (const int seed : {3, 4, 5}) {
    DataSet data = data_of(
        "  tracker: {method: position, rows: 40, noise: 2.0e-5}\n"
        "  gauge: {method: plane, rows: 120, noise: 2.0e-5,\n"
        "    surface: {point: [0.6, 0, 0.2], normal: [0, 0, 1]}}\n"
        "  step: {method: plane, rows: 20, noise: 2.0e-5,\n"
        "    parallel_to: {set: gauge, distance: 0.05, noise: 2.0e-6}}\n",
        seed);
    std::ranges::fill(data.rows.check, 0);
    const Solution solution = identify(rx90(), on_a_line(data, 1, 3));
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(solution.residual.fit.rms_after, 3 * kNoise) << seed;
  }
}

TEST(SmallSets, WithoutADataSheetAreNoQuieterThanTheOthersSay) {
  for (int seed = 1; seed <= 8; ++seed) {
    DataSet data = data_of(
        "  bar: {method: distance, noise_true: 2.0e-5, rows: 21, rows_per_group: 22}\n"
        "  ball: {method: sphere, noise_true: 2.0e-5, rows: 14}\n"
        "  tracker: {method: position, noise_true: 2.0e-5, rows: 16}\n",
        seed);
    std::ranges::fill(data.rows.check, 0);
    const Solution solution = identify(rx90(), data);
    EXPECT_TRUE(solution.converged) << seed;
    for (const SetResult& set : solution.sets)
      EXPECT_GT(set.noise_sigma, kNoise / 4) << set.name << ", seed " << seed;
  }
}

TEST(SmallSets, ThatLeaveNothingToTellTheirNoiseDetermineNothing) {
  const auto why = [](const char* noise) {
    DataSet data = data_of(std::string("  tracker: {method: position, noise_true: 2.0e-5, rows: ") +
                           "20" + noise + "}\n");
    keep_aside(data, {8});
    const Solution solution = identify(rx90(), data);
    if (*noise == 0) {
      EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
    }
    return solution.verdict.why;
  };
  EXPECT_THAT(why(""), HasSubstr("no `noise:` is stated for set tracker"));
  EXPECT_THAT(why(", noise: 2.0e-5"), testing::Not(HasSubstr("no `noise:` is stated")));
}

}  // namespace
}  // namespace selfcal
