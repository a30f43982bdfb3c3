// Edges of a line of this computer on the service's topic, with a line and a clock that are made
// up.
#include "app/bridge/line_relay.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

struct FakeLine : TouchTrigger {
  std::optional<bool> level;
  std::vector<Edge> edges;
  std::optional<bool> closed() override { return level; }
  Result<void> take(std::vector<Edge>& out) override {
    out.insert(out.end(), edges.begin(), edges.end());
    edges.clear();
    return {};
  }
  std::uint64_t dropped() const override { return 0; }
};

struct SentLevel {
  Nanoseconds stamp;
  bool closed;
  bool operator==(const SentLevel&) const = default;
};

struct FakeSender : TriggerSender {
  std::vector<SentLevel>& sent;
  explicit FakeSender(std::vector<SentLevel>& to) : sent(to) {}
  Result<void> send(Nanoseconds stamp, bool closed) override {
    sent.push_back({stamp, closed});
    return {};
  }
};

constexpr Nanoseconds kWallAhead = 1'700'000'000 * kSecond;

/// The wall clock is ahead by kWallAhead, read within 2 us.
ClockReading clocks_of_the_test(int) { return {1000, kWallAhead + 2000, 3000}; }

class LineRelays : public testing::Test {
 protected:
  LineRelays() {
    auto line = std::make_unique<FakeLine>();
    line_ = line.get();
    relay_ = std::make_unique<LineRelay>(std::move(line), std::make_unique<FakeSender>(sent_),
                                         clocks_of_the_test);
  }
  std::vector<SentLevel> sent_;
  FakeLine* line_ = nullptr;
  std::unique_ptr<LineRelay> relay_;
};

TEST_F(LineRelays, PutTheKernelsStampsOnTheWallClock) {
  line_->level = false;
  line_->edges = {{5 * kSecond, true}, {5 * kSecond + 7, false}};
  ASSERT_TRUE(relay_->turn(5 * kSecond + kMillisecond));
  EXPECT_EQ(sent_, (std::vector<SentLevel>{{kWallAhead + 5 * kSecond, true},
                                           {kWallAhead + 5 * kSecond + 7, false}}));
}

TEST_F(LineRelays, RepeatTheLevelWithTheStampOfItsChange) {
  line_->level = true;
  line_->edges = {{5 * kSecond, true}};
  ASSERT_TRUE(relay_->turn(5 * kSecond));
  ASSERT_TRUE(relay_->turn(5 * kSecond + kSecond / 20));
  EXPECT_EQ(sent_.size(), 1u);
  ASSERT_TRUE(relay_->turn(5 * kSecond + kSecond / 10));
  ASSERT_EQ(sent_.size(), 2u);
  EXPECT_EQ(sent_[1], sent_[0]);
}

TEST_F(LineRelays, AreSilentWhileTheLineCannotBeRead) {
  ASSERT_TRUE(relay_->turn(kSecond));
  ASSERT_TRUE(relay_->turn(2 * kSecond));
  EXPECT_TRUE(sent_.empty());
}

TEST_F(LineRelays, StopTheRobotAndEndWhereAnEdgeWasLost) {
  line_->level = true;
  line_->edges = {{5 * kSecond, true, false}};
  const auto turned = relay_->turn(5 * kSecond);
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().what.find("was lost"), std::string::npos);
  ASSERT_EQ(sent_.size(), 1u);
  EXPECT_TRUE(sent_[0].closed);
}

}  // namespace
}  // namespace selfcal
