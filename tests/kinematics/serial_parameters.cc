// Names, parts, priors and the order of preference of a serial robot's parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/robot_file.h"
#include "tests/kinematics/parsed_robot.h"
#include "tests/shared_data.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

using Names = std::vector<std::string>;

const char* const kFrames =
    "  - {name: base, joint: fixed, r: 0.5}\n"
    "  - {name: j1, joint: revolute, alpha: 0.1, d: 0.2, tolerance: {d: 5.0e-4, gear: 2.0e-4}}\n"
    "  - {name: bend, joint: fixed, d: 0.3, nominal: {d: 0.31, alpha: 0.2}}\n"
    "  - {name: j2, joint: prismatic, alpha: 1.5, r: 0.1, gear: 1.01, limits: [0, 1]}\n"
    "  - {name: j3, joint: revolute, d: 0.25, r: 0.4}\n"
    "  - {name: tool, joint: fixed, r: 0.1}\n";

Names names_of(const Robot& robot, const std::vector<int>& indices) {
  Names names;
  for (const int i : indices) names.push_back(robot.parameters()[i].name);
  return names;
}

const Parameter& parameter(const Robot& robot, const std::string& name) {
  const int i = find_parameter(robot, name);
  if (i < 0) ADD_FAILURE() << "no parameter " << name;
  return robot.parameters()[std::max(i, 0)];
}

TEST(SerialParameters, AreFiveAFrameInTheFilesOrderAndThenTheGears) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  Names expected;
  for (const char* frame : {"0", "1", "2", "3", "4", "5"})
    for (const char* field : {"alpha", "d", "theta", "r", "beta"})
      expected.push_back(std::string(field) + frame);
  for (const char* gear : {"K1", "K2", "K3"}) expected.push_back(gear);
  Names names;
  for (const Parameter& p : robot->parameters()) names.push_back(p.name);
  EXPECT_EQ(names, expected);
}

TEST(SerialParameters, BelongToBaseLinksToolAndGearsWithTheirUnits) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(parameter(*robot, "r0").part, Part::base);
  EXPECT_EQ(parameter(*robot, "theta1").part, Part::link);
  EXPECT_EQ(parameter(*robot, "d2").part, Part::link);  // fixed, but between moving frames
  EXPECT_EQ(parameter(*robot, "r5").part, Part::tool);
  EXPECT_EQ(parameter(*robot, "K2").part, Part::gear);
  EXPECT_EQ(parameter(*robot, "K2").frame, "j2");
  EXPECT_EQ(unit(parameter(*robot, "beta4").quantity), "rad");
  EXPECT_EQ(unit(parameter(*robot, "d4").quantity), "m");
  EXPECT_EQ(unit(parameter(*robot, "K1").quantity), "1");
}

TEST(SerialParameters, HaveTheTolerancesOfTheFormatWhereTheFileIsSilent) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(parameter(*robot, "alpha1").tolerance, 2e-3);
  EXPECT_EQ(parameter(*robot, "r2").tolerance, 2e-3);
  EXPECT_EQ(parameter(*robot, "theta0").tolerance, 50e-3);
  EXPECT_EQ(parameter(*robot, "r5").tolerance, 50e-3);
  EXPECT_EQ(parameter(*robot, "K2").tolerance, 1e-4);
  EXPECT_EQ(parameter(*robot, "d1").tolerance, 5e-4);  // given
  EXPECT_EQ(parameter(*robot, "K1").tolerance, 2e-4);  // given
}

TEST(SerialParameters, AreFreeExceptGearsWithoutATolerance) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  for (const Parameter& p : robot->parameters())
    EXPECT_EQ(p.free, p.name != "K2" && p.name != "K3") << p.name;
}

TEST(SerialParameters, KeepTheMakersFigureBesideTheValue) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(parameter(*robot, "d2").value, 0.3);
  EXPECT_EQ(parameter(*robot, "d2").nominal, 0.31);
  EXPECT_EQ(parameter(*robot, "alpha2").nominal, 0.2);
  EXPECT_EQ(parameter(*robot, "K2").value, 1.01);
  EXPECT_EQ(values(*robot)[find_parameter(*robot, "d2")], 0.3);
  EXPECT_EQ(nominal_values(*robot)[find_parameter(*robot, "d2")], 0.31);
}

TEST(SerialParameters, CallLinkLengthsTheNonzeroOnesThatCarryTheScale) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  Names lengths;
  for (const Parameter& p : robot->parameters())
    if (p.link_length) lengths.push_back(p.name);
  // Not d1 (of the first joint), r3 (a prismatic joint's offset), r4 (the last joint's r), r5
  // (tool).
  EXPECT_THAT(lengths, ElementsAre("d2", "d4"));
}

TEST(MatchParameters, TakesNamesFramesWithFieldsAndStars) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  const auto matched = [&](const char* pattern) {
    return names_of(*robot, match_parameters(*robot, pattern));
  };
  EXPECT_THAT(matched("theta3"), ElementsAre("theta3"));
  EXPECT_THAT(matched("j1.theta"), ElementsAre("theta1"));
  EXPECT_THAT(matched("j2.gear"), ElementsAre("K2"));
  EXPECT_THAT(matched("K*"), ElementsAre("K1", "K2", "K3"));
  EXPECT_THAT(matched("*.gear"), ElementsAre("K1", "K2", "K3"));
  EXPECT_THAT(matched("tool.*"), ElementsAre("alpha5", "d5", "theta5", "r5", "beta5"));
  EXPECT_THAT(matched("d*"), ElementsAre("d0", "d1", "d2", "d3", "d4", "d5"));
  EXPECT_THAT(matched("*a5"), ElementsAre("alpha5", "theta5", "beta5"));
  EXPECT_EQ(matched("*").size(), robot->parameters().size());
  for (const char* none : {"", "theta", "theta33", "j1.", "j9.theta", "*x"})
    EXPECT_THAT(matched(none), IsEmpty()) << none;
}

TEST(FindParameter, FindsOneOrNothing) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(find_parameter(*robot, "alpha1"), 5);
  EXPECT_EQ(find_parameter(*robot, "j1.alpha"), 5);
  EXPECT_EQ(find_parameter(*robot, "alpha9"), -1);
  EXPECT_EQ(find_parameter(*robot, "K*"), -1);
}

TEST(SerialPreference, TakesEveryParameterOnce) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  std::vector<int> sorted = robot->preference(), all(robot->parameters().size());
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  EXPECT_EQ(sorted, all);
}

TEST(SerialPreference, PutsThePrismaticJointsOffsetAmongTheFirstAndTheLongestLengthLast) {
  const auto robot = robot_of(with_frames(kFrames));
  ASSERT_NE(robot, nullptr);
  Names names = names_of(*robot, robot->preference());
  names.resize(10);
  // Gears; offsets; d4 = 0.25 before d2 = 0.31 (nominal); alpha2 = 0.2 (nominal), alpha3 = 1.5.
  EXPECT_THAT(names, ElementsAre("K1", "K2", "K3", "theta1", "r3", "theta4", "d4", "d2", "alpha2",
                                 "alpha3"));
}

TEST(SerialPreference, OfTheRx90IsTheOrderThatTheTablesAreMarkedIn) {
  SELFCAL_NEED_SHARED();
  const auto robot = load_robot(shared_dir() / "robots" / "rx90.robot.yaml");
  ASSERT_TRUE(robot.has_value()) << robot.error().what;
  const Names names = names_of(**robot, (*robot)->preference());
  ASSERT_EQ(names.size(), 46u);
  // spec/tables/README.md: (1) gears, offsets; (2) lengths; (3) no odd angle; (4) base, tool.
  EXPECT_THAT(
      Names(names.begin(), names.begin() + 24),
      ElementsAreArray({"K1",     "K2",     "K3",     "K4",     "K5", "K6",     "theta1", "theta2",
                        "theta3", "theta4", "theta5", "theta6", "d3", "r4",     "alpha1", "r0",
                        "theta0", "d1",     "r1",     "d7",     "r6", "alpha7", "theta7", "r7"}));
  // (5) every other alpha, d, theta and r; (6) every beta.
  EXPECT_THAT(Names(names.begin() + 24, names.begin() + 38),
              UnorderedElementsAreArray({"alpha0", "d0", "alpha2", "d2", "r2", "alpha3", "r3",
                                         "alpha4", "d4", "alpha5", "d5", "r5", "alpha6", "d6"}));
  EXPECT_THAT(Names(names.begin() + 38, names.end()),
              UnorderedElementsAreArray(
                  {"beta0", "beta1", "beta2", "beta3", "beta4", "beta5", "beta6", "beta7"}));
}

}  // namespace
}  // namespace selfcal
