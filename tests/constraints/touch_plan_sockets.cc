// Planned touches of sockets and nests.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

TEST(TouchPlan, VisitsEverySocketAndComesInFromItsWayOut) {
  PlannedCell cell;
  const std::vector<Location> places = {{Eigen::Matrix3d::Identity(), {0.7, 0.1, 0.3}},
                                        {Eigen::Matrix3d::Identity(), {0.6, -0.2, 0.3}},
                                        {Eigen::Matrix3d::Identity(), {0.5, 0.3, 0.35}}};
  cell.sockets("position-constraint", places, 12);
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  std::map<int, int> count;
  for (const PlannedTouch& each : plan.touches) {
    ASSERT_GE(each.group, 0);
    ASSERT_LT(each.group, 3);
    ++count[each.group];
    const Eigen::Vector3d place = places[each.group].p;
    EXPECT_LT((located(each.touch).p - place).norm(), kMet);
    EXPECT_EQ(each.end, each.touch);
    const Eigen::Vector3d way = located(each.start).p - place;
    EXPECT_NEAR(way.norm(), cell.options.clearance, kMet);
    EXPECT_NEAR(way.z(), cell.options.clearance, kMet);
  }
  EXPECT_EQ(plan.touches.size(), 12u);
  for (int group = 0; group < 3; ++group) EXPECT_GE(count[group], 3);  // those that tell most
}

TEST(TouchPlan, SitsInANestAsItIsTurned) {
  PlannedCell cell;
  cell.options.tilt = 3.2;
  Location nest = located(home());
  nest.p.z() -= 0.05;
  cell.sockets("location-constraint", {nest}, 6);
  const TouchPlan plan = cell.plan();
  ASSERT_GT(plan.touches.size(), 0u);
  for (const PlannedTouch& each : plan.touches) {
    const Location X = located(each.touch);
    EXPECT_LT((X.p - nest.p).norm(), kMet);
    EXPECT_LT((X.R - nest.R).norm(), kMet);
  }
}

}  // namespace
}  // namespace selfcal
