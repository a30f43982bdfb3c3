// Rows kept aside that are noisier than others of their set, and say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

TEST(HoldoutValidation, CallsNoRowFalseThatIsAsNoisyAsItSays) {
  constexpr double kSigma = 2e-5, kFactor = 8;
  Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "sets: {tracker: {method: position, rows: 240, noise: 2.0e-5}}\n");
  Observations& rows = simulated.data.rows;
  rows.noise_factor.setOnes(rows.rows());
  std::mt19937_64 random(7);
  std::normal_distribution<double> more(0, kSigma * std::sqrt(kFactor * kFactor - 1));
  for (int row = 0; row < rows.rows(); row += 3) {
    rows.noise_factor[row] = kFactor;
    for (int k = 0; k < 3; ++k) rows.position(row, k) += more(random);
  }
  const std::shared_ptr<const Robot> robot = std::move(*load_robot(example("rx90.robot.yaml")));
  const Diagnosis diagnosis = diagnose(robot, simulated.data, quick());
  EXPECT_EQ(std::ranges::count_if(diagnosis.outliers, [](const auto& row) { return row.check; }),
            0);
  EXPECT_EQ(diagnosis.gap.false_rows, 0);
  EXPECT_EQ(diagnosis.verdict.effect, kNone);
}

}  // namespace
}  // namespace selfcal
