// Straight joint moves with finite speed and acceleration.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/trajectory.h"

namespace selfcal {
namespace {

constexpr double kSpeed = 2, kAcceleration = 20;
constexpr Nanoseconds kStart = 5 * kSecond;
constexpr Nanoseconds kTick = kMillisecond;

Eigen::VectorXd joints(double a, double b) { return Eigen::Vector2d(a, b); }

Trajectory move(double a, double b) {
  return Trajectory(joints(0, 0), joints(a, b), kSpeed, kAcceleration, kStart);
}

/// Greatest speed and acceleration of any joint between the ticks.
void expect_within_bounds(const Trajectory& path) {
  constexpr double dt = 1e-3;
  for (Nanoseconds t = kStart - 10 * kTick; t < path.end() + 10 * kTick; t += kTick) {
    const Eigen::VectorXd before = path.q(t - kTick), here = path.q(t), after = path.q(t + kTick);
    // Rounding of q about 1 (1e-16) over dt and dt^2; times truncated to 1 ns.
    ASSERT_LE(((after - here) / dt).cwiseAbs().maxCoeff(), kSpeed * (1 + 1e-6));
    ASSERT_LE(((after - 2 * here + before) / (dt * dt)).cwiseAbs().maxCoeff(),
              kAcceleration * (1 + 1e-6) + 1e-8);
  }
}

TEST(Trajectory, MovesWithinItsSpeedAndAcceleration) {
  expect_within_bounds(move(1, -0.3));
  expect_within_bounds(move(0.05, 0.01));
  Trajectory stopped = move(1, -0.3);
  stopped.stop(kStart + 200 * kMillisecond);
  expect_within_bounds(stopped);
}

TEST(Trajectory, TakesTheTimeOfATrapezoid) {
  // 1 rad at 2 rad/s and 20 rad/s^2: 0.1 s up, 0.1 s down (0.1 rad each), 0.4 s between.
  EXPECT_NEAR(seconds(move(1, 0.5).end() - kStart), 0.6, 1e-8);  // truncated to 1 ns
  // 0.05 rad never comes to full speed: twice sqrt(0.05 / 20) s.
  EXPECT_NEAR(seconds(move(0.05, 0).end() - kStart), 0.1, 1e-8);
}

TEST(Trajectory, BeginsAndEndsWhereItIsAskedTo) {
  const Trajectory path = move(1, -0.3);
  EXPECT_EQ(path.q(0), joints(0, 0));
  EXPECT_EQ(path.q(kStart), joints(0, 0));
  EXPECT_LT((path.q(path.end()) - joints(1, -0.3)).norm(), 1e-12);  // rounding of the segments
  EXPECT_EQ(path.q(path.end() + kSecond), path.q(path.end() + 2 * kSecond));
  EXPECT_NEAR(path.q(kStart + 300 * kMillisecond)[0], 0.5, 1e-12) << "half way in half the time";
}

TEST(Trajectory, TellsWhenAPlaceIsReached) {
  const Trajectory path = move(1, -0.3);
  for (const double s : {0.01, 0.1, 0.5, 0.85, 0.99})
    EXPECT_NEAR(path.s(path.when(s)), s, 2.0 * 1e-9) << s;  // 2 rad/s for 1 ns
  EXPECT_EQ(path.when(1.5), path.end() + 1);
}

TEST(Trajectory, ReachesItsEndHoweverLongItIs) {
  for (int i = 1; i <= 500; ++i) {
    const Trajectory path = move(0.007 * i, -0.3);
    ASSERT_LE(path.when(1.0), path.end()) << 0.007 * i << " rad";
  }
}

TEST(Trajectory, BrakesWithItsAccelerationWhenItIsStopped) {
  Trajectory level = move(1, 0), rising = move(1, 0), braking = move(1, 0);
  level.stop(kStart + 300 * kMillisecond);  // at 2 rad/s: 0.1 s and 0.1 rad more
  EXPECT_NEAR(seconds(level.end() - kStart), 0.4, 1e-8);
  EXPECT_NEAR(level.q(level.end())[0], 0.6, 1e-12);
  rising.stop(kStart + 50 * kMillisecond);  // at 1 rad/s and 0.025 rad: as long and far again
  EXPECT_NEAR(seconds(rising.end() - kStart), 0.1, 1e-8);
  EXPECT_NEAR(rising.q(rising.end())[0], 0.05, 1e-12);
  braking.stop(kStart + 550 * kMillisecond);
  EXPECT_EQ(braking.end(), move(1, 0).end()) << "it brakes already";
}

TEST(Trajectory, StandsWhenThereIsNowhereToGo) {
  const Trajectory path(joints(1, 2), joints(1, 2), kSpeed, kAcceleration, kStart);
  EXPECT_EQ(path.end(), kStart);
  EXPECT_EQ(path.q(kStart + kSecond), joints(1, 2));
  Trajectory still(joints(1, 2));
  still.stop(kSecond);
  EXPECT_EQ(still.q(2 * kSecond), joints(1, 2));
}

}  // namespace
}  // namespace selfcal
