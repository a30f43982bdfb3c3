// A joint of a serial robot that is locked at one reading while the others move: what that costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/identifiability/excitation.h"
#include "tests/contracts/constrained_positions.h"

namespace selfcal {
namespace {

StructuralRank told_with(const std::string& sets, const std::vector<int>& held) {
  const auto arm = six_axis_arm();
  const std::vector<char> all(arm->parameters().size(), 1);
  return structural(*arm, make_sets(sets), all, 80, 1, {}, held);
}

TEST(HeldJoint, StaysAtOneReadingWhileTheConstraintIsMet) {
  const auto arm = six_axis_arm();
  const auto [data, sampled] = at_constrained_positions(*arm, 24, {3});
  ASSERT_EQ(sampled.unreached, "");
  const Eigen::VectorXd q = data.rows.q.col(3);
  EXPECT_TRUE((q.array() == q[0]).all());
  EXPECT_GT(data.rows.q.col(2).maxCoeff() - data.rows.q.col(2).minCoeff(), 0.1);
  const Equations equations(*arm, data, Use::fit);
  for (const RowResidual& row : equations.residuals(sampled.truth)) EXPECT_LT(row.length, 1e-12);
}

/// A chain of n joints has 4 n + 6 parameters that can be told, less 3 of the tool's turns that no
/// position tells, and n gears: a joint less is 5 less.
TEST(HeldJoint, MakesItsTwoLinksOneAndCostsALinksFourParametersAndAGear) {
  const auto arm = six_axis_arm();
  for (const char* sets :
       {"s: {method: location}", "s: {method: position}", "s: {method: position-constraint}"}) {
    const StructuralRank free = told_with(sets, {});
    ASSERT_EQ(free.unreached, "");
    EXPECT_TRUE(free.lost.empty());
    for (const int joint : {1, 2, 3}) {
      const StructuralRank locked = told_with(sets, {joint});
      ASSERT_EQ(locked.unreached, "");
      EXPECT_EQ(locked.rank.total(), free.rank.total() - 5) << sets << joint;
      ASSERT_EQ(locked.lost.size(), 1u);
      EXPECT_EQ(locked.lost[0].count, 5);
      const std::string name = "j" + std::to_string(joint + 1);
      EXPECT_THAT(locked.lost[0].why, testing::StartsWith(name + " is held at one reading"));
      EXPECT_GE(locked.lost[0].parameters.size(), 5u);
      // Its gear does no more than its zero.
      const int gear = find_parameter(*arm, "K" + std::to_string(joint + 1));
      const int zero = find_parameter(*arm, name + ".theta");
      EXPECT_FALSE(locked.rank.status[gear] == Status::identified &&
                   locked.rank.status[zero] == Status::identified);
    }
    EXPECT_EQ(told_with(sets, {1, 3}).rank.total(), free.rank.total() - 10) << sets;
  }
}

/// Six equations, five joints: only the configuration that one started from.
TEST(HeldJoint, LeavesNoOtherWayToMeetALocationWithFiveJoints) {
  EXPECT_THAT(told_with("s: {method: location-constraint}", {3}).unreached,
              testing::HasSubstr("only 1 of 80 configurations"));
}

TEST(HeldJoint, OfAnArmWithEightJointsLeavesWaysToMeetALocation) {
  const auto arm = arm_of(
      "  - {name: base, joint: fixed, r: 0.3}\n"
      "  - {name: j1, joint: revolute, d: 0.05, limits: [-2.8, 2.8]}\n"
      "  - {name: j2, joint: revolute, alpha: -1.57, d: 0.1, limits: [-2.4, 2.4]}\n"
      "  - {name: j3, joint: revolute, alpha: 1.2, d: 0.3, limits: [-2.5, 2.5]}\n"
      "  - {name: j4, joint: revolute, alpha: -1.3, r: 0.25, limits: [-3, 3]}\n"
      "  - {name: j5, joint: revolute, alpha: 1.57, d: 0.2, limits: [-2.5, 2.5]}\n"
      "  - {name: j6, joint: revolute, alpha: 1.1, r: 0.2, limits: [-3, 3]}\n"
      "  - {name: j7, joint: revolute, alpha: -1.57, limits: [-2, 2]}\n"
      "  - {name: j8, joint: revolute, alpha: 1.57, limits: [-3, 3]}\n"
      "  - {name: tool, joint: fixed, alpha: 0.7, d: 0.1, theta: 0.4, r: 0.15}\n");
  const std::vector<char> all(arm->parameters().size(), 1);
  const auto told = [&](const std::vector<int>& held) {
    return structural(*arm, make_sets("s: {method: location-constraint}"), all, 80, 1, {}, held);
  };
  const StructuralRank free = told({}), locked = told({3});
  ASSERT_EQ(free.unreached, "");
  ASSERT_EQ(locked.unreached, "");
  EXPECT_EQ(locked.rank.total(), free.rank.total() - 5);
  ASSERT_EQ(locked.lost.size(), 1u);
  EXPECT_EQ(locked.lost[0].count, 5);
}

}  // namespace
}  // namespace selfcal
