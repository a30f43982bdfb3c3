// Where a further surface would help most, against what it then does.
#include "constraints/planning/next_place.h"

#include <gtest/gtest.h>

#include "constraints/planning/configuration_plan.h"
#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

TEST(NextPlaces, SayWhatAFurtherPlaneIsWorthBesideMoreOfTheFirst) {
  PlanRequest plan;
  plan.pool.sets = {set_of("plane1", "plane")};
  plan.pool.candidates = 150;
  plan.count = 20;
  plan.speed.setOnes(6);
  const ConfigurationPlan first = plan_configurations(rx90(), values(rx90()), plan);
  ASSERT_EQ(first.problem, "");
  NextRequest request;
  request.pool = plan.pool;
  request.pool.candidates = 80;
  request.pool.taken = first.data;
  request.further = set_of("further", "plane");
  request.count = 12;
  request.tries = 6;
  const NextPlaces next = next_places(rx90(), values(rx90()), request);
  EXPECT_EQ(next.problem, "");
  EXPECT_NEAR(next.sigma_now, first.planned.sigma, 1e-4 * first.planned.sigma);
  EXPECT_LT(next.sigma_same, next.sigma_now);
  ASSERT_GE(next.places.size(), 3U);
  EXPECT_LT(next.places.back().sigma, next.sigma_now) << "more rows never know less";
  for (std::size_t i = 1; i < next.places.size(); ++i)
    EXPECT_GE(next.places[i].sigma, next.places[i - 1].sigma);
  for (const NextPlace& each : next.places) {
    EXPECT_NEAR(each.normal.norm(), 1, 1e-12);
    EXPECT_GT(each.radius, 0);
    EXPECT_LT(each.centre.norm(), 3) << "within reach";
  }
}

TEST(NextPlaces, AreNoneWhereTheRobotGetsNowhere) {
  NextRequest request;
  request.pool.sets = {set_of("plane1", "plane")};
  request.pool.candidates = 50;
  request.further = set_of("further", "plane");
  request.workspace.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(9, 9, 9), Eigen::Vector3d(9.1, 9.1, 9.1));
  EXPECT_NE(next_places(rx90(), values(rx90()), request).problem, "");
}

}  // namespace
}  // namespace selfcal
