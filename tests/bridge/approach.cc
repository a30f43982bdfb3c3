#include "app/bridge/approach.h"

#include <gmock/gmock.h>

#include <cmath>

namespace selfcal {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

TEST(Approach, SpeedsUpRunsEvenlyAndSlowsDown) {
  const auto points = approach({0, 1}, {2, 0}, 0.5, 1);

  // 0.5 s and 0.125 rad to 0.5 rad/s, the same at the end, 1.75 rad between at 0.5 rad/s.
  ASSERT_EQ(points.size(), 3);
  EXPECT_DOUBLE_EQ(points[0].time, 0.5);
  EXPECT_DOUBLE_EQ(points[1].time, 4);
  EXPECT_DOUBLE_EQ(points[2].time, 4.5);
  EXPECT_THAT(points[0].q, ElementsAre(DoubleNear(0.125, 1e-12), DoubleNear(0.9375, 1e-12)));
  EXPECT_THAT(points[0].dq, ElementsAre(DoubleNear(0.5, 1e-12), DoubleNear(-0.25, 1e-12)));
  EXPECT_THAT(points[1].q, ElementsAre(DoubleNear(1.875, 1e-12), DoubleNear(0.0625, 1e-12)));
  EXPECT_THAT(points[2].q, ElementsAre(2, 0));
  EXPECT_THAT(points[2].dq, ElementsAre(0, 0));
}

TEST(Approach, NeverReachesItsSpeedOnAShortWay) {
  const auto points = approach({0}, {0.04}, 0.5, 1);

  ASSERT_EQ(points.size(), 2);
  EXPECT_NEAR(points[0].time, 0.2, 1e-12);
  EXPECT_NEAR(points[0].dq[0], 0.2, 1e-12);
  EXPECT_NEAR(points[1].time, 0.4, 1e-12);
}

TEST(Approach, StaysWhereItIs) {
  const auto points = approach({0.3, -1}, {0.3, -1}, 0.5, 1);

  ASSERT_EQ(points.size(), 1);
  EXPECT_GT(points[0].time, 0);
  EXPECT_THAT(points[0].q, ElementsAre(0.3, -1));
  EXPECT_THAT(points[0].dq, ElementsAre(0, 0));
}

// Between two points ros2_controllers lays the cubic of positions and velocities.
TEST(Approach, KeepsToSpeedAndAccelerationBetweenItsPoints) {
  for (const double way : {1e-4, 0.03, 0.25, 0.2500001, 3.0}) {
    const auto points = approach({0}, {way}, 0.5, 1);
    TrajectoryPoint before{0, {0}, {0}};
    for (const TrajectoryPoint& next : points) {
      const double T = next.time - before.time;
      ASSERT_GT(T, 0);
      const double d = next.q[0] - before.q[0], v0 = before.dq[0], v1 = next.dq[0];
      const double c = (3 * d / T - 2 * v0 - v1) / T, e = (v0 + v1 - 2 * d / T) / (T * T);
      for (double s = 0; s <= 1; s += 0.05) {
        const double t = s * T;
        EXPECT_LE(std::abs(v0 + 2 * c * t + 3 * e * t * t), 0.5 + 1e-9) << way;
        EXPECT_LE(std::abs(2 * c + 6 * e * t), 1 + 1e-6) << way;
      }
      before = next;
    }
  }
}

}  // namespace
}  // namespace selfcal
