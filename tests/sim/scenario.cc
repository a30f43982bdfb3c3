// What a scenario's file may say.
#include "sim/scenario.h"

#include <gmock/gmock.h>

#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Scenario, KeepsTheScenariosOwnKeysOutOfTheDataSet) {
  const Scenario scenario = scenario_of(
      "robot: rx90.robot.yaml\n"
      "seed: 5\n"
      "sets:\n"
      "  table: {method: plane, noise: 2.0e-5, rows: 7, noise_true: 3.0e-5,\n"
      "          surface: {point: [0, 0, 0.1], normal: [0, 0, 2]},\n"
      "          within: {center: [0.7, 0, 0.1], radius: 0.5}}\n");
  const Node sets = *data_set_description(scenario, "rx90.robot.yaml").find("sets");
  EXPECT_EQ(sets.find("table")->keys, (std::vector<std::string>{"method", "noise"}));
  EXPECT_EQ(scenario.sets[0].rows, 7);
  EXPECT_EQ(scenario.sets[0].noise, 3.0e-5);
  EXPECT_EQ(scenario.sets[0].surface->normal, Eigen::Vector3d::UnitZ());
}

TEST(Scenario, TakesTheDataSheetsNoiseForTheTrueOneUnlessTold) {
  const Scenario scenario = scenario_of("robot: r\nsets: {a: {method: plane, noise: 2.0e-5}}\n");
  EXPECT_EQ(scenario.sets[0].noise, 2.0e-5);
}

TEST(Scenario, RefusesAnUnknownKeyWithItsLine) {
  EXPECT_THAT(problem_of("robot: r\nsets: {a: {method: plane}}\nerrors:\n  lenght: 1.0e-3\n"),
              StartsWith("scenario.yaml:4: errors: unknown key 'lenght'"));
  EXPECT_THAT(problem_of("robot: r\nsets: {a: {method: plane}}\nsead: 1\n"),
              StartsWith("scenario.yaml:3: scenario: unknown key 'sead'"));
  EXPECT_THAT(problem_of("robot: r\nsets:\n  a: {method: plane,\n      row: 3}\n"),
              StartsWith("scenario.yaml:4: set a: unknown key 'row'"));
}

TEST(Scenario, RefusesNumbersOutOfTheirRangeWithTheirLine) {
  EXPECT_THAT(
      problem_of("robot: r\ncheck: 1\nsets: {a: {method: plane}}\n"),
      StartsWith("scenario.yaml:2: scenario: key 'check': expected a number from 0 to 0.9"));
  EXPECT_THAT(problem_of("robot: r\nfalse_triggers: {size: [2, 1]}\nsets: {a: {method: plane}}\n"),
              HasSubstr("[LEAST, MOST] in metres"));
}

TEST(Scenario, RefusesNamesThatTheRobotOrTheMethodLacks) {
  EXPECT_THAT(
      problem_of("robot: r\nerrors: {parameters:\n  {d99: 0.1}}\nsets: {a: {method: plane}}\n"),
      StartsWith("scenario.yaml:3: errors parameters: no parameter of staubli-rx90"));
  EXPECT_THAT(problem_of("robot: r\nsets: {a: {method: sphere, truth: {cw: 1}}}\n"),
              HasSubstr("no own unknown is called 'cw'; known: cx, cy, cz, radius"));
}

TEST(Scenario, RefusesComplianceOfARobotWithoutMasses) {
  EXPECT_THAT(problem_of("robot: r\ncompliance: {j2: 1.0e-6}\nsets: {a: {method: plane}}\n"),
              StartsWith("scenario.yaml:2: compliance: staubli-rx90 has no masses"));
}

TEST(Scenario, RefusesNoiseOfAnglesWhereTheMethodHasNone) {
  EXPECT_THAT(
      problem_of("robot: r\nsets:\n  a: {method: position,\n      noise_angle_true: 1.0e-4}\n"),
      StartsWith("scenario.yaml:4: set a: `noise_angle_true` is for methods with angles"));
  EXPECT_EQ(problem_of("robot: r\nsets:\n  a: {method: location, noise_angle_true: 1.0e-4}\n"), "");
}

TEST(Scenario, RefusesASurfaceWhereNoPlaneIsUnknown) {
  const std::string surface = "surface: {point: [0, 0, 0], normal: [0, 0, 1]}";
  EXPECT_THAT(problem_of("robot: r\nsets:\n  a: {method: sphere, " + surface + "}\n"),
              HasSubstr("set a: `surface` is for planes whose place is unknown"));
  EXPECT_THAT(
      problem_of("robot: r\nsets:\n  a: {method: plane, plane: [0, 0, -2], " + surface + "}\n"),
      HasSubstr("set a: `surface` is for planes whose place is unknown"));
}

}  // namespace
}  // namespace selfcal
