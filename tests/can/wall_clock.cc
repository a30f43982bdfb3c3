// The wall clock's stamps on the time base.
#include "io/wall_clock.h"

#include <gtest/gtest.h>

#include "io/clock.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kHour = 3600 * kSecond;
constexpr Nanoseconds kOffset = -1'700'000'000 * kSecond;  // monotonic - wall

/// A reading at `now`, `width` wide, with the wall clock read `early` after its beginning.
ClockReading at(Nanoseconds now, Nanoseconds offset, Nanoseconds width = 2000,
                Nanoseconds early = 1000) {
  return {.before = now - width, .wall = now - width + early - offset, .after = now};
}

TEST(WallClock, SaysNothingBeforeItsFirstReading) {
  EXPECT_EQ(WallClock().monotonic(0), std::nullopt);
}

TEST(WallClock, GetsTighterWithEveryReading) {
  WallClock clock;
  const Nanoseconds now = 100 * kSecond;
  clock.observe(at(now, kOffset, 100'000, 10'000), true);
  EXPECT_EQ(clock.uncertainty(), 50'000);
  clock.observe(at(now + kMillisecond, kOffset, 100'000, 95'000), true);
  // Both hold: the offset is within 5 + 10 us.
  EXPECT_EQ(clock.uncertainty(), 7'500);
  const auto t = clock.monotonic(now - kOffset);
  ASSERT_TRUE(t);
  EXPECT_LE(std::abs(*t - now), clock.uncertainty());
  EXPECT_EQ(clock.steps(), 0u);
}

class WallClockStep : public testing::TestWithParam<Nanoseconds> {};

TEST_P(WallClockStep, GivesUpWhatWasStampedAroundItAndThenGoesOn) {
  const Nanoseconds step = GetParam(), now = 100 * kSecond, later = kOffset - step;
  WallClock clock;
  clock.observe(at(now, kOffset), true);
  const Nanoseconds stamp_before = now - kOffset + kMillisecond;

  // A batch with stamps of both times is read after the step, and more of them wait.
  clock.observe(at(now + 2 * kMillisecond, later), false);
  EXPECT_EQ(clock.steps(), 1u);
  EXPECT_FALSE(clock.monotonic(stamp_before));
  EXPECT_FALSE(clock.monotonic(now + 2 * kMillisecond - later));
  clock.observe(at(now + 3 * kMillisecond, later), true);
  EXPECT_FALSE(clock.monotonic(stamp_before));
  EXPECT_FALSE(clock.monotonic(now + 3 * kMillisecond - later));
  // The first reading with nothing left that may be old.
  clock.observe(at(now + 30 * kMillisecond, later), true);
  EXPECT_FALSE(clock.monotonic(now + 30 * kMillisecond - later));

  clock.observe(at(now + 31 * kMillisecond, later), true);
  const auto t = clock.monotonic(now + 31 * kMillisecond - later);
  ASSERT_TRUE(t);
  EXPECT_LE(std::abs(*t - (now + 31 * kMillisecond)), 2000);
  EXPECT_EQ(clock.steps(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WallClockStep,
                         testing::Values(kHour, -kHour, kSecond, -kSecond, kMillisecond,
                                         -kMillisecond, 10'000, -10'000));

TEST(WallClock, GoesOnGivingUpWhileTheQueueIsNotEmpty) {
  WallClock clock;
  const Nanoseconds now = 100 * kSecond;
  clock.observe(at(now, kOffset), true);
  for (int i = 1; i < 100; ++i) {
    clock.observe(at(now + i * kMillisecond, kOffset - kHour), false);
    EXPECT_FALSE(clock.monotonic(now + i * kMillisecond - kOffset + kHour));
  }
}

TEST(WallClock, DoesNotTakeAStepThereAndBackBetweenTwoReadings) {
  WallClock clock;
  const Nanoseconds now = 100 * kSecond;
  clock.observe(at(now, kOffset), true);
  clock.observe(at(now + kMillisecond, kOffset), true);
  // Stamped while the wall clock was an hour off.
  EXPECT_FALSE(clock.monotonic(now - kOffset + kHour));
  EXPECT_FALSE(clock.monotonic(now - kOffset - kHour));
  EXPECT_TRUE(clock.monotonic(now - kOffset));
}

TEST(WallClock, TakesNoTwoProcessorsForAStep) {
  WallClock clock;
  const Nanoseconds now = 100 * kSecond;
  clock.observe(at(now, kOffset, 100, 50), true);
  clock.observe(at(now + kMillisecond, kOffset + 900, 100, 50), true);
  EXPECT_EQ(clock.steps(), 0u);
  EXPECT_TRUE(clock.monotonic(now - kOffset));
}

TEST(WallClock, AgreesWithThisMachinesClocks) {
  WallClock clock;
  for (int i = 0; i < 100; ++i) clock.observe(read_clocks(), true);
  const Nanoseconds before = monotonic_now(), wall = realtime_now(), after = monotonic_now();
  clock.observe(read_clocks(), true);
  const auto t = clock.monotonic(wall);
  ASSERT_TRUE(t);
  EXPECT_GE(*t, before - clock.uncertainty() - WallClock::kSlack);
  EXPECT_LE(*t, after + clock.uncertainty() + WallClock::kSlack);
  EXPECT_EQ(clock.steps(), 0u);
}

}  // namespace
}  // namespace selfcal
