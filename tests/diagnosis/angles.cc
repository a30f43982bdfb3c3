// Rows that measure angles and no lengths, alone and beside others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/diagnosis.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "sim/data_set_maker.h"
#include "sim/scenario.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

Diagnosis diagnosed(const std::string& robot_file, const std::string& scenario) {
  auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/" + robot_file);
  if (!loaded) std::abort();
  const std::shared_ptr<const Robot> robot = *std::move(loaded);
  Problems problems;
  const Simulated made = make_data_set(
      read_scenario(*parse_yaml("robot: r\n" + scenario, "scenario"), problems), *robot, problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return diagnose(robot, made.data, quick());
}

TEST(Angles, AloneAreNoiseInTheirOwnMeasureAndHaveNoGapInLengths) {
  const Diagnosis diagnosis =
      diagnosed("rx90.robot.yaml",
                "seed: 3\nerrors: {length: 0.5e-3, angle: 0.5e-3}\ncheck: 0.3\nsets:\n"
                "  one: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 60}\n"
                "  two: {method: bearing, frame: unknown, noise: 2.0e-5, rows: 60}\n");
  EXPECT_EQ(diagnosis.verdict.effect, kNone) << diagnosis.why;
  EXPECT_EQ(diagnosis.noise, 0);
  EXPECT_EQ(diagnosis.gap.rows, 0);
  EXPECT_THAT(diagnosis.gap_unjudged, HasSubstr("measure no lengths"));
}

TEST(Angles, BesideLengthsLeaveTheNoiseThatOfTheLengths) {
  const Diagnosis diagnosis = diagnosed(
      "irb1600_loaded.robot.yaml",
      "seed: 2\nerrors: {length: 0.5e-3, angle: 0.5e-3}\nencoder_step: 1.0e-5\ncheck: 0.33\n"
      "compliance: {j2: 6.0e-7}\nsets:\n"
      "  tracker: {method: position, noise: 2.0e-5, rows: 60}\n"
      "  tilt: {method: inclinometers, noise: 1.0e-4, rows: 20}\n");
  EXPECT_NE(diagnosis.verdict.effect, kUnknown) << diagnosis.why;
  EXPECT_FALSE(diagnosis.named.empty());
  EXPECT_LT(diagnosis.noise, 1e-4);
}

}  // namespace
}  // namespace selfcal
