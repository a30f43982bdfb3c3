// `selfcal robot convert` for controllers that take less than a calibration finds: what is written
// says how near it comes, and how to undo it.
#include <gmock/gmock.h>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/dh_table.h"
#include "tests/io/scratch.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

/// An arm whose second link is 1 mm long beyond its maker's, its elbow's zero off by 3 mrad, its
/// third axis skew by 2 mrad, and whose second joint gives way.
constexpr const char* kFound = R"(robot: arm
kind: serial
frames:
  - {name: j1, joint: revolute, r: 0.4, limits: [-2.5, 2.5], mass: 30, com: [0, 0, -0.1]}
  - {name: j2, joint: revolute, alpha: -pi/2, d: 0.15, limits: [-1.5, 1.5], mass: 20, com: [0.3, 0, 0]}
  - {name: j3, joint: revolute, d: 0.601, theta: 0.003, beta: 0.002, limits: [-1.5, 2.5], nominal: {d: 0.6, theta: 0, beta: 0}, mass: 10, com: [0.1, 0, 0]}
  - {name: j4, joint: revolute, alpha: -pi/2, d: 0.1, r: 0.6, limits: [-3, 3], mass: 5, com: [0, 0, -0.1]}
  - {name: tool, joint: fixed, xyz: [0.05, 0, 0.1], rpy: [0, 0, 0]}
effects: [{effect: joint_compliance, at: j2, c: 4.0e-6}]
)";

/// HeadFigures of a head: with the maker's numbers and with the written ones (mm).
struct HeadFigures {
  double maker = -1, written = -1;
};
HeadFigures figures_in(const std::string& text) {
  const auto after = [&](const std::string& words) {
    const auto at = text.find(words);
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + words.size()));
  };
  return {after("the end is "), after("\n# and ")};
}

class ForControllers : public testing::Test {
 protected:
  Ran convert(const std::string& robot, const std::string& options) const {
    return run_selfcal("robot convert " + scratch_.write("found.robot.yaml", robot).string() + " " +
                       options);
  }
  Scratch scratch_;
};

TEST_F(ForControllers, GivesOffsetsWithTheirAccuracyAndTheWayBack) {
  const Ran ran = convert(kFound, "--to offsets");
  ASSERT_EQ(ran.status, 0) << ran.out;
  const HeadFigures figures = figures_in(ran.out);
  EXPECT_GT(figures.maker, 1) << ran.out;
  EXPECT_LT(figures.written, 0.7 * figures.maker) << ran.out;
  EXPECT_GT(figures.written, 0.05) << "the link's length is in no offset";
  EXPECT_THAT(ran.out, HasSubstr("\nundo:  # the maker's\n  offsets:\n    j1: 0  # 0 degrees\n"));
  EXPECT_THAT(ran.out, HasSubstr("left out: the effect joint_compliance at j2"));
}

TEST_F(ForControllers, GivesTablesThatComeNearerThanOffsets) {
  EXPECT_EQ(convert(kFound, "--to dh").status, 2);
  const double offsets = figures_in(convert(kFound, "--to offsets").out).written;
  for (const std::string convention : {"standard", "modified"}) {
    const Ran ran = convert(kFound, "--to dh --convention " + convention);
    ASSERT_EQ(ran.status, 0) << ran.out;
    EXPECT_LT(figures_in(ran.out).written, 0.7 * offsets) << ran.out;
    EXPECT_THAT(ran.out, HasSubstr("\n# To undo it, the maker's:\n# joint,alpha [deg],a [mm]"));
    const auto file = scratch_.write("table.csv", ran.out.substr(ran.out.find("# Denavit")));
    const Ran back = run_selfcal("robot convert " + file.string() + " --convention " + convention);
    EXPECT_EQ(back.status, 0) << back.out;
  }
}

TEST_F(ForControllers, LeavesACalibrationWithoutEffectsAsItStands) {
  std::string text = kFound;
  text.resize(text.find("effects:"));
  replace(text, "beta: 0.002, ", "");
  replace(text, ", beta: 0}", "}");
  const Ran ran = convert(text, "--to dh --convention modified");
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_EQ(figures_in(ran.out).written, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("\nj3,0,601,0,0.171887339,revolute\n"));
}

/// What the rows that undo a table come to.
std::unique_ptr<Robot> robot_of_rows(const Scratch& scratch, const std::string& text,
                                     const std::string& convention) {
  std::string rows;
  std::istringstream lines(text.substr(text.find("# To undo it, the maker's:\n")));
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line) && !line.starts_with("# the first");)
    rows += line.substr(2) + "\n";
  const auto table = read_dh_table(scratch.write("undo.csv", rows), convention);
  EXPECT_TRUE(table) << rows;
  auto robot = robot_of(write_yaml(*table), "undo");
  EXPECT_TRUE(robot) << robot.error().what;
  return *std::move(robot);
}

TEST_F(ForControllers, GivesTheMakersBetaInRowsThatUndoATable) {
  const std::string robot = R"(robot: arm
kind: serial
frames:
  - {name: j1, joint: revolute, r: 0.4}
  - {name: j2, joint: revolute, alpha: -1.571, d: 0.15, nominal: {alpha: -pi/2}}
  - {name: j3, joint: revolute, alpha: 0.5, d: 0.601, beta: 0.011, nominal: {d: 0.6, beta: 0.01}}
  - {name: j4, joint: revolute, alpha: -pi/2, d: 0.1, r: 0.6}
)";
  const Eigen::Vector4d q(0.3, -1.2, 0.4, 2);
  const auto arm = robot_of(robot, "arm");
  const Eigen::Vector3d wanted = locate(**arm, nominal_values(**arm), q).p;
  for (const std::string convention : {"standard", "modified"}) {
    const Ran ran = convert(robot, "--to dh --convention " + convention);
    ASSERT_EQ(ran.status, 0) << ran.out;
    const auto undone = robot_of_rows(scratch_, ran.out, convention);
    EXPECT_LT((locate(*undone, values(*undone), q).p - wanted).norm(), 1e-6) << ran.out;
    EXPECT_THAT(ran.out, Not(HasSubstr("The maker's angles beta are in no row")));
  }
}

TEST_F(ForControllers, SaysHowFarRowsThatUndoATableAreOffWhereTheMakersBetaIsInNone) {
  std::string text = kFound;
  text.resize(text.find("effects:"));
  replace(text, "d: 0.6, theta: 0, beta: 0}", "d: 0.6, theta: 0, beta: 0.001}");
  const Ran ran = convert(text, "--to dh --convention standard");
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("# The maker's angles beta are in no row: those that undo it"));
}

// The numbers are fitted to a controller that turns its joints by the maker's ratios.
TEST_F(ForControllers, NamesTheMakersGearRatiosAndThoseThatAreFoundApart) {
  const std::string robot = R"(robot: arm
kind: serial
frames:
  - {name: j1, joint: revolute, r: 0.4, gear: 1.001, nominal: {gear: 1}}
  - {name: j2, joint: revolute, alpha: -pi/2, d: 0.15, gear: -2}
  - {name: j3, joint: revolute, d: 0.6}
)";
  const Ran ran = convert(robot, "--to offsets");
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("left out: the gear ratio of j1 as it was found, 1.001: the "
                                 "controller keeps the maker's, 1\n"));
  EXPECT_THAT(ran.out, Not(HasSubstr("the gear ratio of j1, ")));
  EXPECT_THAT(ran.out, HasSubstr("left out: the gear ratio of j2, -2: positions there are"));
}

constexpr const char* kUrFile = R"(kinematics:
  shoulder: {x: 0, y: 0, z: 0.1807, roll: 0, pitch: 0, yaw: 0}
  upper_arm: {x: 0, y: 0, z: 0, roll: 1.5707963267948966, pitch: 0, yaw: 0}
  forearm: {x: -0.6127, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}
  wrist_1: {x: -0.57155, y: 0, z: 0.17415, roll: 0, pitch: 0, yaw: 0}
  wrist_2: {x: 0, y: -0.11985, z: 0, roll: 1.5707963267948966, pitch: 0, yaw: 0}
  wrist_3: {x: 0, y: 0.11655, z: 0, roll: -1.5707963267948966, pitch: 0, yaw: 0}
  hash: calib_1
)";

TEST_F(ForControllers, GivesUrKinematicsWithTheTcpAndTheFileBefore) {
  const std::string robot = R"(robot: ur10e
kind: serial
frames:
  - {name: j1, joint: revolute, r: 0.1807, theta: 0.002, nominal: {theta: 0}}
  - {name: j2, joint: revolute, alpha: 1.5718, nominal: {alpha: pi/2}}
  - {name: j3, joint: revolute, d: -0.6131, beta: 0.001, nominal: {d: -0.6127, beta: 0}}
  - {name: j4, joint: revolute, d: -0.57155, r: 0.17415}
  - {name: j5, joint: revolute, alpha: pi/2, r: 0.11985}
  - {name: j6, joint: revolute, alpha: -pi/2, r: 0.11655}
  - {name: tool, joint: fixed, xyz: [0.001, 0, 0.1], rpy: [0, 0, 0], nominal: {xyz: [0, 0, 0.1]}}
)";
  const Ran ran = convert(robot, "--to ur --like " + scratch_.write("ur.yaml", kUrFile).string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_GT(figures_in(ran.out).maker, 1);
  EXPECT_EQ(figures_in(ran.out).written, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("C is x y z 1 0 0 mm"));
  std::string undo;
  std::istringstream lines(ran.out.substr(ran.out.find("# To undo it, ")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) undo += line.substr(2) + "\n";
  EXPECT_EQ(undo, kUrFile);
}

TEST_F(ForControllers, GivesPrintersTheNearestThatTheirLinesCome) {
  const std::string delta = R"(robot: printer
kind: linear-delta
towers:
  - {radius: 0.1056, angle: 3.667, rod: 0.2153, endstop: 0.4821, tilt: [0.002, 0], limits: [-0.3, 0], nominal: {radius: 0.105, tilt_x: 0}}
  - {radius: 0.105, angle: 5.7596, rod: 0.2155, endstop: 0.4825, limits: [-0.3, 0]}
  - {radius: 0.105, angle: 1.5708, rod: 0.2151, endstop: 0.4818, limits: [-0.3, 0]}
)";
  const Ran ran = convert(delta, "--to delta");
  ASSERT_EQ(ran.status, 0) << ran.out;
  const auto at = ran.out.find("# Of printer.");
  ASSERT_NE(at, std::string::npos) << ran.out;
  const HeadFigures figures = figures_in(ran.out.substr(at));
  EXPECT_GT(figures.maker, 0.1) << ran.out;
  EXPECT_LT(figures.written, 0.5 * figures.maker) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("left out: tilts of towers, up to 2.0000 mrad"));
}

}  // namespace
}  // namespace selfcal
