// The tool and the device that measures it, by numbers worked by hand.
#include "tests/effects/by_hand.h"

namespace selfcal {
namespace {

TEST(ToolShiftByHand, MovesTheTipInTheToolsAxesFromItsMomentOn) {
  const std::string moved_tool =
      "[{effect: tool_shift, moment: 500, x: 1.0e-4, z: -3.0e-5, rz: 2.0e-4}]";
  Held held;
  held.time = 499;
  expect_near(moved(kTurntable, moved_tool, held).p, 0, 0, 0, 0);
  held.time = 500;
  expect_near(moved(kTurntable, moved_tool, held).p, 100e-6, 0, -30e-6, 1e-15);
  expect_near(moved(kTurntable, moved_tool, held).turn, 0, 0, 200e-6, 1e-11);
  // A quarter turn of the joint carries the tool's x into the world's y; the tool turns about its
  // tip, which does not move for it.
  held.q = numbers({90 * kDegree});
  expect_near(moved(kTurntable, moved_tool, held).p, 0, 100e-6, -30e-6, 1e-15);
  held.time = kUnknown;
  expect_near(moved(kTurntable, moved_tool, held).p, 0, 0, 0, 0);
}

/// A tool of 0.2 m along x of the last joint, whose z is level (the world's y); 3 kg at 0.1 m of it
/// where it says so.
std::string gripper(const char* mass) {
  return std::string("robot: gripper\nkind: serial\nframes:\n") +
         "  - {name: j1, joint: revolute, alpha: -1.5707963267948966, mass: 50, com: [9, 9, 9]}\n" +
         "  - {name: tool, joint: fixed, d: 0.2" + mass + "}\n";
}
const char* const kThreeKg = ", mass: 3, com: [-0.1, 0, 0]";

TEST(ToolComplianceByHand, LetsTheToolSagByItsOwnWeightAlone) {
  // 3 kg x 9.81 x 0.1 m = 2.943 N m about the world's y, which is z of j1's frame: x 5e-5 = 147.15
  // urad, and the tip 0.2 m out sinks by 29.43 um. What the arm itself weighs does nothing.
  const std::string soft = "[{effect: tool_compliance, twist: 5.0e-5}]";
  const Moved level = moved(gripper(kThreeKg), soft, {});
  expect_near(level.turn, 0, 147.15e-6, 0);
  expect_near(level.p, 0, 0, -29.43e-6);
  // 60 degrees down: half of the moment, across the tool: 14.715 um along (-sin 60, 0, -cos 60).
  const Moved steep = moved(gripper(kThreeKg), soft, {numbers({60 * kDegree})});
  expect_near(steep.p, -12.744e-6, 0, -7.358e-6);
}

TEST(ToolComplianceByHand, HangsAKilogramAtTheTipWhereTheFileIsSilent) {
  // 1 kg x 9.81 x 0.2 m = 1.962 N m x 5e-5 = 98.1 urad; with `mass: 2` twice that.
  const Moved one = moved(gripper(""), "[{effect: tool_compliance, twist: 5.0e-5}]", {});
  expect_near(one.turn, 0, 98.1e-6, 0);
  const Moved two = moved(gripper(""), "[{effect: tool_compliance, mass: 2, twist: 5.0e-5}]", {});
  expect_near(two.turn, 0, 196.2e-6, 0);
}

TEST(ToolComplianceByHand, GivesWayToTheWrenchAboutEachAxisOfTheMount) {
  // 10 N along the tool's z (the world's y) at 0.2 m along x: M = (0.2, 0, 0) x (0, 0, 10) =
  // (0, -2, 0) in the mount's axes; 1 N m about x. The weight is set aside by `mass: 0`.
  Held held;
  held.wrench = numbers({0, 0, 10, 1, 0, 0});
  const Moved by = moved(
      gripper(""), "[{effect: tool_compliance, mass: 0, bend_x: 3.0e-5, bend_y: 1.0e-4}]", held);
  // The mount's y points down (-z of the world), its x along the world's: 30 urad about x, and -200
  // urad about -z; the tip moves by (0, 0, 200e-6) x (0.2, 0, 0) = 40 um along the world's y.
  expect_near(by.turn, 30e-6, 0, 200e-6);
  expect_near(by.p, 0, 40e-6, 0);
}

TEST(ToolComplianceByHand, LetsTheToolItselfBendByForcesAtItsTip) {
  // 29.43 N along the tool's y: 1e-6 m/N along y, which points down, and 5e-7 m/N along x.
  const std::string soft = "[{effect: tool_compliance, by: tool, yy: 1.0e-6, xy: 5.0e-7}]";
  const Moved level = moved(gripper(kThreeKg), soft, {});
  expect_near(level.turn, 0, 0, 0);
  expect_near(level.p, 14.715e-6, 0, -29.43e-6);
  // 60 degrees down (25.487, 14.715, 0) N: 7.3575 um along x = (1/2, 0, -sin 60), and 14.715 um +
  // 12.7434 um along y = (-sin 60, 0, -1/2).
  const Moved steep = moved(gripper(kThreeKg), soft, {numbers({60 * kDegree})});
  expect_near(steep.p, 3.67875e-6 - 23.7799e-6, 0, -6.37178e-6 - 13.7292e-6);
  // 10 N along the tool's z, which is the world's y, by themselves: 10 um along y, which points
  // down, and 20 um along x.
  Held held;
  held.wrench = numbers({0, 0, 10, 0, 0, 0});
  const std::string askew =
      "[{effect: tool_compliance, by: tool, mass: 0, xz: 2.0e-6, yz: 1.0e-6}]";
  expect_near(moved(gripper(""), askew, held).p, 20e-6, 0, -10e-6);
}

MeasurementContext tracked() {
  MeasurementContext context;
  context.sets = {{"table", TouchedSurface::plane, {0, 0, 0}, {0, 0, 1}},
                  {"tracker", TouchedSurface::none, {}, {}, true}};
  context.times = {0, 100};
  context.temperatures = {20, 24};
  context.reference = 22;
  return context;
}

TEST(ScaleErrorByHand, StretchesWhatTheDeviceMeasuresFromWhereItStands) {
  // 5 ppm/K x 4 K = 20 ppm of (1, 0, 0) - (3, -2, 0.5) = (-2, 2, -0.5) m: (-40, 40, -10) um.
  MeasurementContext context = tracked();
  context.sets[1].device = {3, -2, 0.5};
  Held held;
  held.set = 1;
  held.temperature = 26;
  const std::string warm = "{effect: scale_error, at: tracker, by: temperature, k: 5.0e-6";
  expect_near(moved(kTurntable, "[" + warm + "}]", held, context).p, -40e-6, 40e-6, -10e-6, 1e-15);
  expect_near(moved(kTurntable, "[" + warm + ", origin: [0, 0, 1]}]", held, context).p, 20e-6, 0,
              -20e-6, 1e-15);
}

TEST(ScaleErrorByHand, StretchesWhatIsMeasuredInTheWorldsFrameFromItsOrigin) {
  // 50 ppm of the tip at (1, 0, 0), and at 90 degrees of (0, 1, 0); not of the other set's rows.
  const std::string long_unit = "[{effect: scale_error, at: tracker, s: 5.0e-5}]";
  Held held;
  held.set = 1;
  expect_near(moved(kTurntable, long_unit, held, tracked()).p, 50e-6, 0, 0, 1e-15);
  held.q = numbers({90 * kDegree});
  expect_near(moved(kTurntable, long_unit, held, tracked()).p, 0, 50e-6, 0, 1e-15);
  held.set = 0;
  expect_near(moved(kTurntable, long_unit, held, tracked()).p, 0, 0, 0, 0);
}

TEST(ScaleErrorByHand, GrowsWithTheTemperatureAboutTheRowsMean) {
  // 10 ppm/K x (25 C - 22 C) = 30 ppm of a metre; with reference 20 C 50 ppm.
  Held held;
  held.set = 1;
  held.temperature = 25;
  const std::string warm = "[{effect: scale_error, at: tracker, by: temperature, k: 1.0e-5}]";
  expect_near(moved(kTurntable, warm, held, tracked()).p, 30e-6, 0, 0, 1e-15);
  const std::string from_20 =
      "[{effect: scale_error, at: tracker, by: temperature, reference: 20, k: 1.0e-5}]";
  expect_near(moved(kTurntable, from_20, held, tracked()).p, 50e-6, 0, 0, 1e-15);
  held.temperature = kUnknown;
  expect_near(moved(kTurntable, warm, held, tracked()).p, 0, 0, 0, 0);
}

}  // namespace
}  // namespace selfcal
