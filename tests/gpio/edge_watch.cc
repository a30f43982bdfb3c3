// What the kernel reports of a line, injected: edges that got lost, levels that were read late, a
// line that chatters.
#include "io/gpio/edge_watch.h"

#include <gmock/gmock.h>

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Nanoseconds kMicrosecond = 1000;

// An edge without its moment's name, to compare.
struct Seen {
  Nanoseconds time;
  bool closed, timed;
  bool operator==(const Seen&) const = default;
};
void PrintTo(const Seen& seen, std::ostream* out) {
  *out << seen.time << (seen.closed ? " closed" : " open") << (seen.timed ? "" : " (not timed)");
}

class EdgeWatchTest : public testing::Test {
 protected:
  std::vector<Seen> add(const std::vector<LineEvent>& events) {
    now = std::max(now, events.back().time + 20 * kMicrosecond);
    return seen([&](std::vector<Edge>& out) { watch.add(events, now, out); });
  }
  std::vector<Seen> check(bool closed) {
    now += 2 * kMillisecond;
    return seen([&](std::vector<Edge>& out) { watch.check(closed, now, out); });
  }
  template <class Do>
  std::vector<Seen> seen(const Do& what) {
    std::vector<Edge> out;
    what(out);
    std::vector<Seen> all;
    for (const Edge& edge : out) all.push_back({edge.time, edge.closed, edge.timed});
    return all;
  }

  Nanoseconds now = kSecond;
  EdgeWatch watch{false, kSecond};
};

TEST_F(EdgeWatchTest, PassesOnEdgesThatAlternate) {
  EXPECT_THAT(add({{2 * kSecond, true}, {3 * kSecond, false}}),
              ElementsAre(Seen{2 * kSecond, true, true}, Seen{3 * kSecond, false, true}));
  EXPECT_EQ(watch.lost(), 0u);
  EXPECT_FALSE(watch.suspicious());
}

TEST_F(EdgeWatchTest, KnowsTheLevelOnceItHasBeenWatchedForAWhile) {
  EXPECT_FALSE(watch.closed(kSecond + EdgeWatch::kWatchFirst - 1));
  EXPECT_EQ(watch.closed(kSecond + EdgeWatch::kWatchFirst), false);
  add({{2 * kSecond, true}});
  EXPECT_EQ(watch.closed(now), true);
}

// The kernel took the stamp at the closing and read the level when the contact had bounced open.
TEST_F(EdgeWatchTest, PutsAClosingThatWasReadTooLateAtItsStamp) {
  const Nanoseconds touch = 2 * kSecond;
  EXPECT_THAT(add({{touch, false}, {touch + 80 * kMicrosecond, true}}),
              ElementsAre(Seen{touch, true, true}, Seen{touch, false, true},
                          Seen{touch + 80 * kMicrosecond, true, true}));
  EXPECT_EQ(watch.lost(), 1u);
}

/// As many edges from 2 s on as the kernel's queue holds, 10 ns apart.
std::vector<LineEvent> full_queue() {
  std::vector<LineEvent> full;
  for (std::size_t i = 0; i < EdgeWatch::kQueue; ++i)
    full.push_back({2 * kSecond + static_cast<Nanoseconds>(i) * 10, i % 2 == 0});
  return full;
}

TEST_F(EdgeWatchTest, DoesNotTrustTheStampAfterAFullQueue) {
  add(full_queue());
  EXPECT_TRUE(watch.suspicious()) << "to be looked at soon";
  EXPECT_EQ(watch.lost(), 1u) << "two, or any even number, would not show in the level";
  EXPECT_THAT(watch.trouble(now), HasSubstr("some are lost"));
  EXPECT_EQ(watch.trouble(now + EdgeWatch::kTellFor), "");

  const Nanoseconds later = 2 * kSecond + kMillisecond;
  EXPECT_THAT(add({{later, true}, {later + 10, false}}),
              ElementsAre(Seen{later, true, false}, Seen{later + 10, false, true}));
  EXPECT_EQ(watch.lost(), 1u);
}

TEST_F(EdgeWatchTest, CountsWhatAFullQueueHidesOnceHoweverItShows) {
  std::vector<LineEvent> full = full_queue();
  add(full);
  const Nanoseconds opens = 2 * kSecond + kMillisecond;
  EXPECT_THAT(add({{opens, false}}),
              ElementsAre(Seen{opens, true, false}, Seen{opens, false, false}))
      << "by the next edge";
  EXPECT_EQ(watch.lost(), 1u);

  for (LineEvent& event : full) event.time += kSecond;
  add(full);
  EXPECT_THAT(check(true), IsEmpty());
  EXPECT_TRUE(watch.suspicious());
  const auto found = check(true);
  EXPECT_THAT(found, ElementsAre(Seen{now, true, false})) << "by the level";
  EXPECT_EQ(watch.lost(), 2u);
  EXPECT_FALSE(watch.suspicious());
}

TEST_F(EdgeWatchTest, TrustsTheNextStampOnceTheLevelWasFoundRightAfterAFullQueue) {
  add(full_queue());
  EXPECT_THAT(check(false), IsEmpty());
  EXPECT_FALSE(watch.suspicious());
  EXPECT_THAT(add({{3 * kSecond, true}}), ElementsAre(Seen{3 * kSecond, true, true}));
}

TEST_F(EdgeWatchTest, FindsALostEdgeInTheLevelAndSaysThatItsMomentIsNotKnown) {
  EXPECT_THAT(check(true), IsEmpty()) << "the edge may be on its way";
  EXPECT_TRUE(watch.suspicious());
  const auto found = check(true);
  EXPECT_THAT(found, ElementsAre(Seen{now, true, false}));
  EXPECT_EQ(watch.lost(), 1u);
  EXPECT_THAT(check(true), IsEmpty());
}

TEST_F(EdgeWatchTest, LosesNothingWhenTheEdgeWasOnItsWay) {
  check(true);
  const Nanoseconds late = now + 1;
  EXPECT_THAT(add({{late, true}}), ElementsAre(Seen{late, true, true}));
  EXPECT_THAT(check(true), IsEmpty());
  EXPECT_EQ(watch.lost(), 0u);
}

TEST_F(EdgeWatchTest, CountsAGapInTheNumbers) {
  add({{2 * kSecond, true, 1}, {2 * kSecond + 10, false, 2}});
  // Three are missing: closed, open, closed.
  EXPECT_THAT(add({{2 * kSecond + 90, false, 6}, {3 * kSecond, true, 7}}),
              ElementsAre(Seen{2 * kSecond + 90, true, false}, Seen{2 * kSecond + 90, false, false},
                          Seen{3 * kSecond, true, true}));
  EXPECT_EQ(watch.lost(), 3u);
  EXPECT_THAT(watch.trouble(now), HasSubstr("some are lost"));
  // Two are missing: the levels alternate, and yet the stamp is not that of the touch.
  EXPECT_THAT(add({{4 * kSecond, false, 10}}), ElementsAre(Seen{4 * kSecond, false, false}));
  EXPECT_EQ(watch.lost(), 5u);
}

TEST_F(EdgeWatchTest, TellsOfALineThatPicksUpTheMains) {
  Nanoseconds t = 2 * kSecond;
  for (int i = 0; i < 100; ++i, t += 10 * kMillisecond) add({{t, i % 2 == 0}});
  EXPECT_THAT(watch.trouble(now), HasSubstr("chatters"));
  EXPECT_EQ(watch.trouble(now + EdgeWatch::kTellFor), "");
}

TEST_F(EdgeWatchTest, CallsNeitherBouncingTouchesNorFiftyEdgesASecondChatter) {
  Nanoseconds t = 2 * kSecond;
  for (int touch = 0; touch < 20; ++touch, t += 100 * kMillisecond)
    for (int i = 0; i < 41; ++i) add({{t + i * 40 * kMicrosecond, i % 2 == 0}});
  EXPECT_EQ(watch.trouble(now), "");
  for (int i = 0; i < 200; ++i, t += 20 * kMillisecond) add({{t, i % 2 == 1}});
  EXPECT_EQ(watch.trouble(now), "");
}

TEST_F(EdgeWatchTest, RefusesStampsOfAnotherClock) {
  EXPECT_THAT(seen([&](std::vector<Edge>& out) {
                watch.add({{1'790'000'000 * kSecond, true}}, now, out);
              }),
              ElementsAre(Seen{now, true, false}));
  EXPECT_THAT(watch.trouble(now), HasSubstr("another clock"));
}

}  // namespace
}  // namespace selfcal
