// Rows kept aside that are noisier than others of their set, and say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>

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
  EXPECT_EQ(diagnosis.verdict.effect, kNone) << diagnosis.why;
}

/// Two instruments, one a tenth as exact as the other; of `aside` of its rows every one but each
/// tenth judges, of the other each tenth.
DataSet two_instruments(const std::string& aside) {
  DataSet data = made(
                     "robot: rx90.robot.yaml\nseed: 5\nerrors: {length: 5.0e-4, angle: 5.0e-4}\n"
                     "sets:\n  tracker: {method: position, rows: 100, noise: 2.0e-5}\n"
                     "  camera: {method: position, rows: 100, noise: 2.0e-4}\n")
                     .data;
  for (int row = 0; row < data.rows.rows(); ++row)
    data.rows.check[row] = (data.sets[data.rows.set[row]].name == aside) != (row % 10 == 0);
  return data;
}

TEST(HoldoutValidation, TakesTheNoiseOfEachRowsInstrument) {
  const std::shared_ptr<const Robot> robot = std::move(*load_robot(example("rx90.robot.yaml")));
  for (const char* const aside : {"camera", "tracker"}) {
    const Diagnosis diagnosis = diagnose(robot, two_instruments(aside), quick());
    EXPECT_EQ(diagnosis.verdict.effect, kNone) << diagnosis.why;
    // 90 rows of the one and 10 of the other, of three coordinates each. Ten fit rows tell a noise
    // by some 25 freedoms, and three sigma of that are 0.4.
    const bool camera = std::string(aside) == "camera";
    const double squares = (camera ? 0.9 : 0.1) * 4e-8 + (camera ? 0.1 : 0.9) * 4e-10;
    EXPECT_NEAR(diagnosis.gap.noise_floor / std::sqrt(3 * squares), 1, 0.4) << aside;
  }
}

TEST(HoldoutValidation, LeavesOneInstrumentItsNoiseWhereTheCauseShowsInAnother) {
  const std::shared_ptr<const Robot> robot =
      std::move(*load_robot(example("irb1600_loaded.robot.yaml")));
  const std::string arm =
      "robot: irb1600_loaded.robot.yaml\nseed: 3\nerrors: {length: 5.0e-4, angle: 5.0e-4}\n"
      "check: 0.33\ncompliance: {j2: 6.0e-7}\nsets:\n";
  // The sag shows in the tilt farther than in the touches, by their noises: once it is known, the
  // tilt is less noisy than it looked, and the touches are as noisy as before.
  const Diagnosis touched =
      diagnose(robot,
               made(arm + "  tilt: {method: inclinometers, noise_angle: 1.0e-5, rows: 80}\n"
                          "  table: {method: plane, noise: 2.0e-5, rows: 60,\n"
                          "    surface: {point: [0.9, 0.0, 0.4], normal: [0, 0, 1]},\n"
                          "    within: {center: [0.9, 0.0, 0.4], radius: 0.5}}\n",
                    *robot)
                   .data,
               quick());
  EXPECT_TRUE(touched.outliers.empty()) << touched.outliers.size() << " rows are called false";
  // And where it shows in what is measured, that is as exact as it is.
  const Diagnosis tracked = diagnose(
      robot,
      made(arm + "  arm: {method: location, noise: 2.0e-5, noise_angle: 2.0e-5, rows: 60}\n"
                 "  tilt: {method: inclinometers, noise_angle: 1.0e-4, rows: 80}\n",
           *robot)
          .data,
      quick());
  // 3 sigma of what 200 freedoms tell of a sigma.
  EXPECT_NEAR(tracked.gap.noise_floor / (std::sqrt(3.0) * 2e-5), 1, 0.15);
}

}  // namespace
}  // namespace selfcal
