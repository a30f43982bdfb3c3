// Clocks, stamps and being woken.

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "io/clock.h"
#include "io/dds/convert.h"
#include "io/dds/time_mapping.h"

namespace selfcal {
namespace {

TEST(TimeMapping, KnowsNothingBeforeTheFirstMessage) {
  const TimeMapping mapping;

  EXPECT_FALSE(mapping.ours(5));
}

TEST(TimeMapping, KeepsDifferencesWhateverTheDelays) {
  TimeMapping mapping;
  mapping.observe(1'000, 5'000);

  EXPECT_FALSE(mapping.observe(2'000, 5'000 + kSecond));
  EXPECT_EQ(mapping.ours(1'000), 5'000);
  EXPECT_EQ(mapping.ours(2'001), 6'001);
  EXPECT_EQ(mapping.steps(), 0);
}

TEST(TimeMapping, IsTakenAnewWhenTheSendersClockSteps) {
  TimeMapping mapping;
  mapping.observe(0, 0);

  EXPECT_TRUE(mapping.observe(100 * kSecond, 2 * kSecond));
  EXPECT_EQ(mapping.ours(101 * kSecond), 3 * kSecond);
  EXPECT_TRUE(mapping.observe(0, 4 * kSecond));
  EXPECT_EQ(mapping.ours(0), 4 * kSecond);
  EXPECT_EQ(mapping.steps(), 2);
}

TEST(TimeMapping, FollowsADriftOnceItIsASecond) {
  constexpr Nanoseconds kHour = 3600 * kSecond;
  TimeMapping mapping;
  mapping.observe(0, 0);

  EXPECT_FALSE(mapping.observe(10 * kHour, 10 * kHour + kSecond));
  EXPECT_EQ(mapping.ours(10 * kHour), 10 * kHour);
  EXPECT_TRUE(mapping.observe(11 * kHour, 11 * kHour + kSecond + 1));
  EXPECT_EQ(mapping.ours(11 * kHour), 11 * kHour + kSecond + 1);
}

TEST(Stamps, ComeBackAsTheyWere) {
  for (const Nanoseconds t : {Nanoseconds{0}, Nanoseconds{1}, Nanoseconds{-1}, kSecond, -kSecond,
                              Nanoseconds{1'790'000'000'123'456'789}, -5 * kSecond - 7}) {
    EXPECT_EQ(nanoseconds(time_of(t)), t);
    EXPECT_LT(time_of(t).nanosec_, 1'000'000'000u);
  }
}

TEST(Wakeup, RemembersNewsUntilSomebodyWaits) {
  Wakeup wakeup;
  wakeup.notify();
  wakeup.notify();

  EXPECT_TRUE(wakeup.wait(kSecond));
  EXPECT_FALSE(wakeup.wait(0));
  EXPECT_FALSE(wakeup.wait(-5));
}

TEST(SystemClock, IsWokenFromAnotherThread) {
  Wakeup wakeup;
  SystemClock clock(wakeup);
  const Nanoseconds start = clock.now();
  std::thread other([&] { wakeup.notify(); });

  clock.wait(std::numeric_limits<Nanoseconds>::max());

  EXPECT_LT(clock.now() - start, 10 * kSecond);
  other.join();
}

TEST(SystemClock, WaitsNoLongerThanAskedFor) {
  Wakeup wakeup;
  SystemClock clock(wakeup);
  const Nanoseconds start = clock.now();

  clock.wait(3 * kMillisecond);

  EXPECT_GE(clock.now() - start, 3 * kMillisecond);
  EXPECT_GT(clock.unix_ms(), 1'600'000'000'000);
}

}  // namespace
}  // namespace selfcal
