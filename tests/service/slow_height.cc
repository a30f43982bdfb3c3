// How far before a surface a touch begins slowly, by hand.
#include "app/service/session/slow_height.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/service/session/touch_decision.h"
#include "constraints/planning/touch_plan.h"
#include "tests/service/stored_session.h"

namespace selfcal {
namespace {

/// At twelve places of a patch, out by a plane exactly: 1 mm, 10 mm/m along x, -20 mm/m along y.
std::vector<FeltContact> of_a_tilted_plane() {
  std::vector<FeltContact> felt;
  for (int i = 0; i < 12; ++i) {
    const double x = 0.1 * std::cos(i), y = 0.1 * std::sin(i);
    felt.push_back({{0.5 + x, y, 0.2}, 1e-3 + 0.01 * x - 0.02 * y});
  }
  return felt;
}

TEST(SlowHeight, IsAllOfItUntilEightTouchesMoreThanAPlaneNeedsWereFelt) {
  std::vector<FeltContact> felt = of_a_tilted_plane();
  felt.resize(10);
  EXPECT_EQ(slow_height({}, {0.5, 0, 0.2}, 0.01, 0.01), 0.01);
  EXPECT_EQ(slow_height(felt, {0.5, 0, 0.2}, 0.01, 0.01), 0.01);
}

TEST(SlowHeight, FollowsThePlaneThroughWhatWasFeltDownToAQuarterOfTheSearch) {
  const std::vector<FeltContact> felt = of_a_tilted_plane();
  EXPECT_NEAR(slow_height(felt, {0.7, -0.1, 0.2}, 0.01, 0.01), 1e-3 + 2e-3 + 2e-3, 1e-9);
  EXPECT_NEAR(slow_height(felt, {0.5, 0, 0.2}, 0.01, 0.01), 2.5e-3, 1e-9) << "1 mm";
  EXPECT_NEAR(slow_height(felt, {0.5, 0.2, 0.2}, 0.01, 0.01), 2.5e-3, 1e-9) << "3 mm behind";
  EXPECT_NEAR(slow_height(felt, {0.5, -0.8, 0.2}, 0.01, 0.01), 0.01, 1e-9) << "17 mm before";
  EXPECT_NEAR(slow_height(felt, {0.7, -0.1, 0.2}, 0.014, 0.01), 4e-3 + 5e-3, 1e-9)
      << "what the robot itself needs stays";
}

// A delta's bed is felt as a bowl.
TEST(SlowHeight, FollowsABowlOnceTouchesEnoughWereFelt) {
  std::vector<FeltContact> felt;
  const auto bowl = [](double x, double y) { return 0.3 * x * x + 0.2 * x * y + 1e-3; };
  for (int i = 0; i < 13; ++i) {
    const double x = 0.013 * i * std::cos(2 * i), y = 0.013 * i * std::sin(2 * i);
    felt.push_back({{x, y, 0.1}, bowl(x, y)});
  }
  EXPECT_GT(slow_height(felt, {0.12, 0.02, 0.1}, 0.01, 0.01), 7e-3) << "as a plane at first";
  felt.push_back({{-0.1, 0.1, 0.1}, bowl(-0.1, 0.1)});
  EXPECT_NEAR(slow_height(felt, {0.12, 0.02, 0.1}, 0.01, 0.01), bowl(0.12, 0.02), 1e-9);
}

// Ten at one place, 0.8 mm before and behind in turn: sigma = 0.8 sqrt(10 / 9) mm, of a prediction
// there sqrt(1 + 1 / 10) times that.
TEST(SlowHeight, LeavesFiveSigmasOfWhatThePlaneDoesNotTell) {
  std::vector<FeltContact> felt;
  for (int i = 0; i < 10; ++i) felt.push_back({{0.5, 0, 0.2}, i % 2 == 0 ? 8e-4 : -8e-4});
  EXPECT_NEAR(slow_height(felt, {0.5, 0, 0.2}, 0.01, 0.01),
              5 * 8e-4 * std::sqrt(10.0 / 9 * (1 + 1.0 / 10)), 1e-9);
}

TEST(SlowHeight, IsAllOfItWhereNothingWasFeltThatTellsOfThePlace) {
  std::vector<FeltContact> felt;
  for (int i = 0; i < 10; ++i) felt.push_back({{0.5, 0, 0.2}, 0});
  EXPECT_EQ(slow_height(felt, {0.6, 0, 0.2}, 0.01, 0.01), 0.01) << "another place";
  for (int i = 0; i < 10; ++i) felt[i].expected.x() += 0.01 * i;
  EXPECT_EQ(slow_height(felt, {0.55, 0.1, 0.2}, 0.01, 0.01), 0.01) << "beside a line";
  EXPECT_EQ(slow_height(felt, {0.55, 0, 0.2}, 0.01, 0.01), 0.0025) << "on it";
}

TEST(SlowHeight, IsAPlaceOnTheWayFromTheStartOfAStepToItsContact) {
  const auto config = load_cell({{"sets.touches", "16"}});
  ASSERT_TRUE(config) << config.error().what;
  const Robot& robot = *config->robot;
  const TouchPlan plan = plan_touches(robot, values(robot), config->sets, config->targets,
                                      config->obstacles, config->workspace, config->plan);
  Session session;
  session.plan = steps_of(plan, config->sets);
  const Decoding decoding = decoding_of(*config);
  const double search = config->plan.search;
  const StepRecord& last = session.plan.back();
  const auto height = [&](const std::vector<double>& q) {
    return (endpoint(robot, vector_of(q)) - endpoint(robot, vector_of(last.touch))).z();
  };
  for (int i = 0; i < 13; ++i) {
    if (i < 11) {
      EXPECT_EQ(slow_from(robot, session, decoding, last, search), last.start);
    }
    const Eigen::VectorXd start = vector_of(session.plan[i].start),
                          touch = vector_of(session.plan[i].touch);
    const Eigen::VectorXd q = touch + 0.4 * (start - touch);  // felt 4 mm before the surface
    TouchRecord felt = touch_of(i);
    for (Eigen::Index j = 0; j < 6; ++j)
      felt.before.counts[j] = felt.after.counts[j] = std::llround(q[j] / kStep) + 1000;
    session.touches.push_back(felt);
  }
  const std::vector<double> from = slow_from(robot, session, decoding, last, search);
  EXPECT_NEAR(height(last.start), search, 2e-4);
  EXPECT_NEAR(height(from), 4e-3, 3e-4);
  session.touches.resize(11);
  session.touches.back().outcome = TouchOutcome::outlier;
  EXPECT_EQ(slow_from(robot, session, decoding, last, search), last.start) << "ten good ones";
}

}  // namespace
}  // namespace selfcal
