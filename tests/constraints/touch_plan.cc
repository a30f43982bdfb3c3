// Planned touches lie where they should.
#include "constraints/planning/touch_plan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

TEST(TouchPlan, TouchesItsPlanesWithinPatchLimitsAndTilt) {
  const PlannedCell cell = table_and_wall();
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  ASSERT_EQ(plan.touches.size(), 24u);
  for (const PlannedTouch& each : plan.touches) {
    const Obstacle& plane = cell.obstacles[each.set];
    const Location X = located(each.touch);
    EXPECT_NEAR(plane.outward.dot(X.p - plane.point), 0, kMet);
    EXPECT_LE((X.p - plane.within.centre).norm(), plane.within.radius + kMet);
    EXPECT_LE(std::acos(X.R.col(2).dot(-plane.outward)), cell.options.tilt + kMet);
    for (const Eigen::VectorXd& q : {each.start, each.end})
      for (Eigen::Index j = 0; j < 6; ++j) {
        const Joint& joint = rx90().joints()[j];
        EXPECT_GE(q[j], joint.lower + cell.options.limit_margin * joint.range());
        EXPECT_LE(q[j], joint.upper - cell.options.limit_margin * joint.range());
      }
  }
}

TEST(TouchPlan, BeginsItsClearanceBeforeTheSurfaceAndGivesUpItsSearchBehindIt) {
  const PlannedCell cell = table_and_wall();
  for (const PlannedTouch& each : cell.plan().touches) {
    const Obstacle& plane = cell.obstacles[each.set];
    const auto height = [&](const Eigen::VectorXd& q) {
      return plane.outward.dot(located(q).p - plane.point);
    };
    EXPECT_NEAR(height(each.outside), cell.options.clearance, kMet);
    EXPECT_NEAR(height(each.start), cell.options.slow, kMet);
    EXPECT_NEAR(height(each.end), -cell.options.search, kMet);
    // The joint path in is straight: it passes the planned place by what it is bent, at most an
    // eighth of way^2 over the arm's length about 1 m, 2e-4 m, and joints of opposite turns.
    double nearest = HUGE_VAL;
    for (int i = 0; i <= 1000; ++i)
      nearest = std::min(nearest, (located(each.start + i * 1e-3 * (each.end - each.start)).p -
                                   located(each.touch).p)
                                      .norm());
    EXPECT_LT(nearest, 2e-3);
  }
}

TEST(TouchPlan, TouchesBothOfTwoParallelFaces) {
  PlannedCell cell;
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0, 0.2).normalized();
  const Eigen::Vector3d near(-0.60, -0.18, 0.6);
  const Eigen::Vector3d far(-0.796, 0.18, 0.561);
  cell.plane(near, normal, 0.12, 8).plane(far, normal, 0.12, 8);
  cell.sets[1].reference = 0;  // its normal is the other's: the plan takes the nominal one
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  std::map<int, int> count;
  for (const PlannedTouch& each : plan.touches) {
    const Eigen::Vector3d p = located(each.touch).p;
    EXPECT_NEAR(normal.dot(p - (each.set == 0 ? near : far)), 0, kMet);
    ++count[each.set];
  }
  EXPECT_EQ(count[0], 8);
  EXPECT_EQ(count[1], 8);
}

TEST(TouchPlan, KeepsTheShareOfEverySetAsideToJudge) {
  PlannedCell cell = table_and_wall(20);
  cell.options.check = 0.3;
  std::map<int, int> checks;
  for (const PlannedTouch& each : cell.plan().touches) checks[each.set] += each.check;
  EXPECT_EQ(checks[0], 6);
  EXPECT_EQ(checks[1], 6);
}

TEST(TouchPlan, IsTheSameForTheSameSeedAndAnotherForAnother) {
  PlannedCell cell = table_and_wall(6);
  const TouchPlan one = cell.plan(), again = cell.plan();
  cell.options.seed = 2;
  const TouchPlan other = cell.plan();
  ASSERT_EQ(one.touches.size(), again.touches.size());
  for (std::size_t i = 0; i < one.touches.size(); ++i)
    EXPECT_EQ(one.touches[i].touch, again.touches[i].touch);
  EXPECT_NE(one.touches[0].touch, other.touches[0].touch);
}

TEST(TouchPlan, SaysWhichSetIsOutOfReach) {
  PlannedCell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, 4);
  cell.plane({5, 0, 0.15}, {0, 0, 1}, 0.25, 4);
  const TouchPlan plan = cell.plan();
  EXPECT_THAT(plan.unreached, HasSubstr("set plane1: only 0 of 4"));
  EXPECT_EQ(plan.touches.size(), 4u);
}

}  // namespace
}  // namespace selfcal
