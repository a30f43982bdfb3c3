// Robots come back from their own text, and calibrating one does not change its hash.
#include "io/files/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::MatchesRegex;
using testing::StartsWith;

const char* const kArm =
    "robot: arm\n"
    "kind: serial\n"
    "frames:\n"
    "  - {name: base, joint: fixed, r: 0.5}\n"
    "  - {name: j1, joint: revolute, d: 0.3, limits: [-2, 2], tolerance: {d: 5.0e-4}}\n"
    "  - {name: j2, joint: prismatic, alpha: 1.5, limits: [0, 1]}\n"
    "  - {name: tool, joint: fixed, r: 0.1, mass: 2.5, com: [0, 0, 0.05]}\n";

std::unique_ptr<Robot> load(const Scratch& scratch, std::string_view text) {
  auto robot = load_robot(scratch.write("arm.robot.yaml", text));
  EXPECT_TRUE(robot.has_value()) << robot.error().what;
  return robot ? std::move(*robot) : nullptr;
}

TEST(RobotFile, ComesBackFromItsOwnTextWithNewValues) {
  const Scratch scratch;
  const auto nominal = load(scratch, kArm);
  ASSERT_NE(nominal, nullptr);
  Eigen::VectorXd xi = values(*nominal);
  for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] += 1e-4 / static_cast<double>(3 + i);
  const std::string text = robot_text(*nominal, xi);
  const auto calibrated = load(scratch, text);
  ASSERT_NE(calibrated, nullptr);
  EXPECT_EQ(values(*calibrated), xi) << text;
  EXPECT_EQ(nominal_values(*calibrated), nominal_values(*nominal));
  EXPECT_EQ(robot_text(*calibrated, xi), text);
  EXPECT_EQ(model_hash(*calibrated), model_hash(*nominal));
}

TEST(RobotFile, HasAHashThatFollowsTheModel) {
  const Scratch scratch;
  const auto one = load(scratch, kArm);
  std::string text = kArm;
  text.replace(text.find("d: 0.3"), 6, "d: 0.4");
  const auto other = load(scratch, text);
  ASSERT_TRUE(one && other);
  EXPECT_THAT(model_hash(*one), MatchesRegex("sha256:[0-9a-f]+"));
  EXPECT_EQ(model_hash(*one).size(), 7u + 64u);
  EXPECT_NE(model_hash(*one), model_hash(*other));
}

TEST(RobotFile, IsRefusedWhereItsUnitsAreNot) {
  const Scratch scratch;
  const struct {
    const char *right, *wrong, *told;
  } cases[] = {
      {"d: 0.3", "d: 300", "frame 1: key 'd': expected metres, at most 50 (millimetres?)"},
      {"r: 0.5", "r: 5000", "frame 0: key 'r': expected metres, at most 1000"},
      {"r: 0.1", "r: 100", "frame 3: key 'r': expected metres, at most 50"},
      {"alpha: 1.5", "alpha: 90", "frame 2: key 'alpha': expected radians"},
      {"[-2, 2]", "[-160, 160]", "frame 1: key 'limits': expected radians"},
      {"[0, 1]", "[0, 1200]", "frame 2: key 'limits': expected metres"},
      {"{d: 5.0e-4}", "{d: 1}", "expected 1 sigma each, above 0 and below 1 (m or rad)"},
      {"limits: [0, 1]", "gear: 0", "expected a ratio other than 0"},
      {"kind: serial", "kind: serial\ngravity: [0, 0, -9810]", "expected m/s^2"},
  };
  for (const auto& each : cases) {
    std::string text = kArm;
    text.replace(text.find(each.right), std::strlen(each.right), each.wrong);
    const auto robot = load_robot(scratch.write("arm.robot.yaml", text));
    ASSERT_FALSE(robot.has_value()) << each.wrong;
    EXPECT_THAT(robot.error().what, testing::HasSubstr(each.told));
  }
}

TEST(RobotFile, IsRefusedWithFileAndLine) {
  const Scratch scratch;
  const auto path = scratch.write(
      "bad.yaml", "robot: a\nkind: serial\nframes:\n  - {name: j1, joint: revolute, alhpa: 1}\n");
  const auto robot = load_robot(path);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().exit_status, kBadInput);
  EXPECT_THAT(robot.error().what, StartsWith(path.string() + ":4: "));
}

}  // namespace
}  // namespace selfcal
