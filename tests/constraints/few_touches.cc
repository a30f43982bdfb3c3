// Rows kept aside of a surface that the rows which identify hardly touch, or of postures in which
// the robot is not what these say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kNoise = 2e-5;  // m

/// Touches of two planes that identify, and of a third, of which every touch but the first two is
/// kept aside.
DataSet third_plane_kept_aside(bool repeated) {
  DataSet data =
      made(
          "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets:\n"
          "  table: {method: plane, rows: 90, noise: 2.0e-5,\n"
          "    surface: {point: [0.6, 0, 0.2], normal: [0, 0, 1]}}\n"
          "  wall: {method: plane, rows: 90, noise: 2.0e-5,\n"
          "    surface: {point: [0.7, 0, 0.6], normal: [-1, 0, 0]}}\n"
          "  side: {method: plane, rows: 30, noise: 2.0e-5,\n"
          "    surface: {point: [0.4, 0.6, 0.4], normal: [0, -1, 0]}}\n")
          .data;
  int seen = 0;
  if (repeated) data.rows.repeat.assign(data.rows.rows(), -1);
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.set[row] != 2) continue;
    data.rows.check[row] = seen >= (repeated ? 4 : 2);
    if (repeated && seen < 4) data.rows.repeat[row] = seen / 2;
    ++seen;
  }
  return data;
}

TEST(FewTouches, LeaveTheirSurfaceToTheRowsThatJudge) {
  for (const bool repeated : {false, true}) {
    const DataSet data = third_plane_kept_aside(repeated);
    const Solution solution = identify(rx90(), data);
    EXPECT_LT(solution.residual.check.rms_after, 3 * kNoise)
        << "metres, where two touches were to place a plane";
    EXPECT_THAT(solution.warnings,
                Contains(HasSubstr("set side: its rows to identify are too few to place it")));
    EXPECT_TRUE(solution.residual.check_by_set.back().aligned);
  }
}

TEST(FewTouches, PlaceTheirSurfaceFromThreeOn) {
  DataSet data = third_plane_kept_aside(false);
  int seen = 0;
  for (int row = 0; row < data.rows.rows(); ++row)
    if (data.rows.set[row] == 2) data.rows.check[row] = ++seen > 10;
  const Solution solution = identify(rx90(), data);
  EXPECT_THAT(solution.warnings, Not(Contains(HasSubstr("too few to place it"))));
  EXPECT_FALSE(solution.residual.check_by_set.back().aligned);
}

TEST(RowsKeptAside, OftenBeyondTheNoiseAreNoFalseOnes) {
  DataSet data = made(
                     "robot: rx90.robot.yaml\nseed: 3\ncheck: 0.33\n"
                     "errors: {length: 1.0e-3, angle: 1.0e-3}\n"
                     "sets: {tracker: {method: position, rows: 90, noise: 2.0e-5}}\n")
                     .data;
  const auto often = HasSubstr("rows kept aside lie beyond the noise of those that identify");
  EXPECT_THAT(identify(rx90(), data).warnings, Not(Contains(often)));
  int moved = 0;
  for (int row = 0; row < data.rows.rows() && moved < 6; ++row)
    if (data.rows.check[row]) data.rows.position(row, 2) += 4e-4, ++moved;
  EXPECT_THAT(identify(rx90(), data).warnings,
              Contains(testing::AllOf(often, HasSubstr("set tracker: 6 of 30 "))));
}

// 36 unknowns from 30 scalars and the maker's tolerances: elsewhere the rows are met several times
// worse than the noise, and no reading is false. One that is false by more than that is told.
TEST(RowsKeptAside, BeyondTheNoiseAloneAreForeseenByDoubtfulParameters) {
  DataSet data = made(
                     "robot: rx90.robot.yaml\nseed: 5\n"
                     "errors: {length: 1.0e-3, angle: 1.0e-3}\n"
                     "sets: {tracker: {method: position, rows: 210, noise: 2.0e-5}}\n")
                     .data;
  for (int row = 0; row < data.rows.rows(); ++row) data.rows.check[row] = row >= 10;
  const Solution few = identify(rx90(), data);
  EXPECT_GT(few.residual.check.rms_after, 3 * kNoise);
  EXPECT_LE(few.outliers.size(), 2u);
  data.rows.position(100, 2) += 0.05;
  const Solution wrong = identify(rx90(), data);
  EXPECT_THAT(wrong.outliers, Contains(testing::Field(&Outlier::row, 101)));
}

}  // namespace
}  // namespace selfcal
