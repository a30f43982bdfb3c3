// What each method tells of a Gough-Stewart platform (Besnard and Khalil 2001, as the Hexa Slide
// paper cites them), what it does not and why; inclinometers and locked joints worked by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/identifiability/excitation.h"
#include "kinematics/rotation.h"
#include "tests/contracts/method_case.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

StructuralRank told_of_platform(const std::string& sets) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  const std::vector<char> all(robot->parameters().size(), 1);
  StructuralRank structure = structural(*robot, make_sets(sets), all, 80, 1);
  EXPECT_EQ(structure.unreached, "");
  return structure;
}

std::vector<int> lost_counts(const StructuralRank& structure) {
  std::vector<int> counts;
  for (const Lost& lost : structure.lost) counts.push_back(lost.count);
  return counts;
}

TEST(PlatformTold, IsEveryParameterByLocations) {
  const StructuralRank structure = told_of_platform("s: {method: location}");
  EXPECT_EQ(structure.rank.total(), 42);
  EXPECT_TRUE(structure.lost.empty());
}

TEST(PlatformTold, LosesTheTurnsOfThePlatformsFrameByPositions) {
  const StructuralRank structure = told_of_platform("s: {method: position}");
  EXPECT_EQ(structure.rank.total(), 39);
  ASSERT_THAT(lost_counts(structure), ElementsAre(3));
  EXPECT_EQ(structure.lost[0].why,
            "the platform's frame may be moved: turn about x, turn about y, turn about z");
}

TEST(PlatformTold, LosesPlacesAndHeadingByInclinometers) {
  const StructuralRank structure = told_of_platform("s: {method: inclinometers}");
  EXPECT_EQ(structure.rank.total(), 35);
  ASSERT_THAT(lost_counts(structure), ElementsAre(4, 3));
  EXPECT_EQ(
      structure.lost[0].why,
      "the base's frame may be moved: shift along x, shift along y, shift along z, turn about "
      "z");
  EXPECT_THAT(structure.lost[1].why, HasSubstr("the platform's frame may be moved: shift"));
}

TEST(PlatformTold, LosesBothFramesAndTheLockedLegsOffsetByOneLock) {
  for (const char* joint : {"universal", "spherical"}) {
    const StructuralRank structure = told_of_platform(
        std::string("s: {method: locked-joint, lock: {leg: 3, joint: ") + joint + "}}");
    EXPECT_EQ(structure.rank.total(), 29) << joint;
    EXPECT_EQ(structure.nuisance, 2);
    ASSERT_THAT(lost_counts(structure), ElementsAre(6, 6, 1)) << joint;
    EXPECT_EQ(structure.lost[0].why, "the base's frame may be put anywhere");
    EXPECT_EQ(structure.lost[1].why, "the platform's frame may be put anywhere");
    EXPECT_THAT(structure.lost[2].why, HasSubstr("within leg3: locked, it keeps its direction"));
    EXPECT_THAT(structure.lost[2].parameters, testing::Contains("offset3"));
  }
}

TEST(PlatformTold, LosesBothFramesAloneBySeveralLocksInTurn) {
  const char* const cases[] = {
      "a: {method: locked-joint, lock: {leg: 1, joint: universal}}\n"
      "b: {method: locked-joint, lock: {leg: 4, joint: universal}}",
      "a: {method: locked-joint, lock: {leg: 2, joint: spherical}}\n"
      "b: {method: locked-joint, lock: {leg: 3, joint: spherical}}",
      "a: {method: locked-joint, lock: {leg: 2, joint: universal}}\n"
      "b: {method: locked-joint, lock: {leg: 2, joint: spherical}}",
      "a: {method: locked-joint, lock: {leg: 1, joint: universal}}\n"
      "b: {method: locked-joint, lock: {leg: 3, joint: universal}}\n"
      "c: {method: locked-joint, lock: {leg: 5, joint: spherical}}"};
  for (const char* sets : cases) {
    const StructuralRank structure = told_of_platform(sets);
    EXPECT_EQ(structure.rank.total(), 30) << sets;
    EXPECT_THAT(lost_counts(structure), ElementsAre(6, 6)) << sets;
  }
}

TEST(PlatformTold, LosesMotionsAlongThePlaneAndTurnsOfTheProbeByTouches) {
  // Readings in metres give the size: no scale is among what is lost.
  const StructuralRank known = told_of_platform("s: {method: plane, plane: [0.1, 0.2, -1.4]}");
  EXPECT_EQ(known.rank.total(), 36);
  EXPECT_THAT(lost_counts(known), ElementsAre(3, 3));
  const StructuralRank unknown = told_of_platform("s: {method: plane}");
  EXPECT_EQ(unknown.rank.total(), 33);
  EXPECT_THAT(lost_counts(unknown), ElementsAre(6, 3));
}

TEST(PlatformTold, IsNothingOfAJointThatTheRobotLacks) {
  const auto sets = make_sets("s: {method: locked-joint, lock: {leg: 2, joint: spherical}}");
  EXPECT_EQ(lacking_body(*robot_of(kind_examples().at("gough-stewart")), sets), "");
  EXPECT_THAT(lacking_body(*robot_of(kind_examples().at("linear-delta")), sets),
              HasSubstr("set s: this linear-delta robot has no such joint to lock"));
}

/// One row of a method whose body stands at X.
MethodOutput row_at(const Method& method, const Location& X, Observations& data,
                    const Eigen::VectorXd& nuisance) {
  Locations now;
  for (int lane = 0; lane < kLanes; ++lane) place(now, lane, X);
  const int row = 0;
  MethodOutput out;
  out.resize(2, method.tangent_dimension(), 0, 0);
  method.evaluate({1, &data, &row, &now, nullptr, &nuisance, nullptr, nullptr}, out);
  return out;
}

TEST(Inclinometers, ReadRollAndPitchWhateverTheHeading) {
  const auto sets = make_sets("s: {method: inclinometers}");
  Observations data;
  for (const char* name : {"alpha", "beta"}) data.measured[name] = Eigen::VectorXd::Zero(1);
  for (const double heading : {-1.0, 0.0, 2.0}) {
    const Location X{rpy_rotation({0.3, -0.2, heading}), {1, 2, 3}};
    sets[0].method->measure(X, {}, {}, data, 0);
    EXPECT_NEAR(data.column("alpha")[0], 0.3, 1e-15);  // rounding
    EXPECT_NEAR(data.column("beta")[0], -0.2, 1e-15);
  }
  // Level, a turn about x is alpha and one about y is beta.
  data.column("alpha")[0] = -0.1;
  data.column("beta")[0] = 0.05;
  const MethodOutput out = row_at(*sets[0].method, {}, data, {});
  EXPECT_NEAR(out.r(0, 0), 0.1, 1e-15);
  EXPECT_NEAR(out.r(0, 1), -0.05, 1e-15);
  Eigen::RowVectorXd expected(12);
  expected << 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0;
  EXPECT_LT((out.G_now.row(0).matrix() - expected).norm(), 1e-15);
}

TEST(LockedJoint, IsLeftByTheAngleThatTheLegTurnsFromItsLock) {
  const auto sets = make_sets("s: {method: locked-joint, lock: {leg: 1, joint: universal}}");
  const Method& method = *sets[0].method;
  Random random(1);
  const Location locked{rpy_rotation({0.4, 0.1, -0.3}), {}};
  const Eigen::VectorXd nuisance = method.through(locked, nullptr, random);
  const auto reports = method.report(nuisance, nullptr);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(reports[i].value, locked.R(i, 2), 1e-15);
  Observations data;
  for (const double angle : {0.0, 1e-5, 0.3, 2.5}) {
    // About an axis across the leg it leaves the lock by all of the angle; about itself it does
    // not.
    const Location bent{locked.R * exp_rotation({0, angle, 0}), {}};
    EXPECT_NEAR(row_at(method, bent, data, nuisance).r.row(0).matrix().norm(), angle, 1e-14);
    const Location spun{locked.R * exp_rotation({0, 0, angle}), {}};
    EXPECT_NEAR(row_at(method, spun, data, nuisance).r.row(0).matrix().norm(), 0, 1e-15);
  }
}

TEST(LockedJoint, IsRefusedWithoutALegOrWithAnotherJoint) {
  const auto problem = [](const std::string& entry) {
    Problems problems;
    make_set("s", *parse_yaml(entry, "dataset.yaml"), problems);
    return problems.any() ? problems.list.front() : "";
  };
  EXPECT_THAT(problem("{method: locked-joint}"), HasSubstr("lock"));
  EXPECT_THAT(problem("{method: locked-joint, lock: {leg: 7, joint: universal}}"),
              HasSubstr("leg"));
  EXPECT_THAT(problem("{method: locked-joint, lock: {leg: 1, joint: knee}}"),
              HasSubstr("universal or spherical"));
}

}  // namespace
}  // namespace selfcal
