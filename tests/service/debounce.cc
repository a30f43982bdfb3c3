// A chattering contact: which level counts, and since when.
#include "app/service/front_end/debounce.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

constexpr Nanoseconds kQuiet = 2 * kMillisecond;
constexpr Nanoseconds kMicrosecond = 1000;

TEST(Debouncer, CountsALevelOnceItHasLastedAndDatesItAtTheFirstEdge) {
  Debouncer debouncer(kQuiet);
  debouncer.add({1 * kSecond, true}, 1 * kSecond);
  EXPECT_FALSE(debouncer.settled(1 * kSecond + kQuiet - 1));
  const auto edge = debouncer.settled(1 * kSecond + kQuiet);
  ASSERT_TRUE(edge);
  EXPECT_TRUE(edge->closed);
  EXPECT_EQ(edge->time, 1 * kSecond);
  EXPECT_FALSE(debouncer.settled(2 * kSecond)) << "told once";
}

TEST(Debouncer, DatesABouncingTouchAtItsFirstContact) {
  Debouncer debouncer(kQuiet);
  for (int i = 0; i < 7; ++i)
    debouncer.add({kSecond + i * 40 * kMicrosecond, i % 2 == 0}, kSecond + i * 40 * kMicrosecond);
  const Nanoseconds last = kSecond + 6 * 40 * kMicrosecond;
  EXPECT_FALSE(debouncer.settled(last + kQuiet - 1)) << "counted from the last edge";
  const auto edge = debouncer.settled(last + kQuiet);
  ASSERT_TRUE(edge && edge->closed);
  EXPECT_EQ(edge->time, kSecond);
  EXPECT_EQ(debouncer.glitches(), 0u);
}

TEST(Debouncer, CountsABurstThatEndsAtTheOldLevelAsAGlitch) {
  Debouncer debouncer(kQuiet);
  debouncer.add({kSecond, true}, kSecond);
  debouncer.add({kSecond + 50 * kMicrosecond, false}, kSecond + 50 * kMicrosecond);
  EXPECT_FALSE(debouncer.settled(kSecond + kQuiet));
  EXPECT_FALSE(debouncer.settled(2 * kSecond));
  EXPECT_EQ(debouncer.glitches(), 1u);
  debouncer.add({3 * kSecond, true}, 3 * kSecond);
  EXPECT_EQ(debouncer.settled(4 * kSecond)->time, 3 * kSecond) << "the glitch is forgotten";
}

TEST(Debouncer, PassesOnThatTheMomentOfATouchIsNotKnown) {
  Debouncer debouncer(kQuiet);
  debouncer.add({kSecond, true, false}, kSecond);
  debouncer.add({kSecond + 50 * kMicrosecond, false}, kSecond);
  debouncer.add({kSecond + 90 * kMicrosecond, true}, kSecond);
  EXPECT_FALSE(debouncer.settled(kSecond + kQuiet)->timed);
  debouncer.add({2 * kSecond, false}, 2 * kSecond);
  EXPECT_TRUE(debouncer.settled(3 * kSecond)->timed);
  debouncer.reconcile(true, 4 * kSecond);
  EXPECT_FALSE(debouncer.settled(5 * kSecond)->timed) << "noticed, not felt";
}

TEST(Debouncer, IgnoresAnEdgeToTheLevelThatAlreadyIs) {
  Debouncer debouncer(kQuiet);
  debouncer.begin(true);
  debouncer.add({kSecond, true}, kSecond);
  EXPECT_FALSE(debouncer.settled(2 * kSecond));
  EXPECT_EQ(debouncer.glitches(), 0u);
}

TEST(Debouncer, TellsTheOpeningAfterTheClosing) {
  Debouncer debouncer(kQuiet);
  debouncer.add({kSecond, true}, kSecond);
  EXPECT_TRUE(debouncer.settled(2 * kSecond)->closed);
  debouncer.add({3 * kSecond, false}, 3 * kSecond);
  const auto edge = debouncer.settled(4 * kSecond);
  ASSERT_TRUE(edge);
  EXPECT_FALSE(edge->closed);
  EXPECT_EQ(edge->time, 3 * kSecond);
}

TEST(Debouncer, WaitsForEdgesThatAreStampedAheadOfTheClock) {
  Debouncer debouncer(kQuiet);
  debouncer.add({kSecond, true}, kSecond);
  EXPECT_FALSE(debouncer.settled(kSecond - kMillisecond));
}

TEST(Debouncer, TellsALevelAtOnceWithoutAQuietTime) {
  Debouncer debouncer(0);
  debouncer.add({kSecond, true}, kSecond);
  EXPECT_TRUE(debouncer.settled(kSecond));
}

TEST(Debouncer, CountsQuietFromTheHearingWhateverClockTheStampsAreOf) {
  Debouncer debouncer(kQuiet);
  debouncer.begin(false);
  const Nanoseconds ahead = 900 * kMillisecond;
  debouncer.add({kSecond + ahead, true}, kSecond);
  EXPECT_FALSE(debouncer.settled(kSecond + kQuiet - 1));
  EXPECT_EQ(debouncer.settled(kSecond + kQuiet)->time, kSecond + ahead);
}

TEST(Debouncer, DatesAContactJustAfterAGlitchByItsOwnEdge) {
  Debouncer debouncer(kQuiet);
  debouncer.begin(false);
  debouncer.add({kSecond, true}, 2 * kSecond);
  debouncer.add({kSecond + kMicrosecond, false}, 2 * kSecond);
  const Nanoseconds contact = kSecond + kMicrosecond + kQuiet;
  debouncer.add({contact, true}, 2 * kSecond);
  EXPECT_EQ(debouncer.settled(3 * kSecond)->time, contact);
  EXPECT_EQ(debouncer.glitches(), 1U);
}

/// Pulses of `width`, one every `period`, for a second; whether it was ever said to chatter.
bool chatters(Nanoseconds width, Nanoseconds period) {
  Debouncer debouncer(kQuiet);
  debouncer.begin(false);
  bool ever = false;
  for (Nanoseconds t = kSecond; t < 2 * kSecond; t += period) {
    debouncer.add({t, true}, t);
    debouncer.settled(t + width - 1);
    debouncer.add({t + width, false}, t + width);
    debouncer.settled(t + period - 1);
    ever = ever || debouncer.chatters(t + period);
  }
  EXPECT_FALSE(debouncer.chatters(4 * kSecond));
  return ever;
}

TEST(Debouncer, KnowsALineThatChattersFromOneThatTouches) {
  EXPECT_TRUE(chatters(7 * kMillisecond, 14 * kMillisecond));
  EXPECT_TRUE(chatters(kQuiet / 2, 20 * kMillisecond)) << "glitches count as well";
  EXPECT_FALSE(chatters(50 * kMillisecond, 200 * kMillisecond)) << "five touches a second";
}

}  // namespace
}  // namespace selfcal
