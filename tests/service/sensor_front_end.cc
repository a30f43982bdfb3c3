// What the service hears of a trigger that does not behave.
#include "app/service/front_end/sensor_front_end.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

class NoEncoders final : public EncoderSource {
 public:
  const std::vector<EncoderScale>& scales() const override { return scales_; }
  Result<void> take(std::vector<EncoderSample>&) override { return {}; }
  std::uint64_t dropped() const override { return 0; }

 private:
  std::vector<EncoderScale> scales_;
};

class NoMotion final : public Motion {
 public:
  Result<void> request(const MotionRequest&) override { return {}; }
  Result<void> stop(const std::string&) override { return {}; }
  Result<void> take(std::vector<MotionReply>&) override { return {}; }
};

class PlayedTrigger final : public TouchTrigger {
 public:
  std::optional<bool> closed() override { return level; }
  Result<void> take(std::vector<Edge>& out) override {
    if (arrives_meanwhile) set(std::exchange(arrives_meanwhile, std::nullopt)->time, true);
    out.insert(out.end(), edges_.begin(), edges_.end());
    edges_.clear();
    return {};
  }
  std::uint64_t dropped() const override { return 0; }
  void set(Nanoseconds time, bool closed) {
    level = closed;
    edges_.push_back({time, closed});
  }

  bool level = false;
  std::optional<Edge> arrives_meanwhile;  ///< between two looks at the port

 private:
  std::vector<Edge> edges_;
};

class HeardTrigger : public testing::Test {
 protected:
  /// Listens every millisecond from `from` to `to` (ms).
  void listen(int from, int to) {
    for (int ms = from; ms <= to; ++ms) front_end.listen(ms * kMillisecond, events);
  }
  void SetUp() override { listen(0, 10); }

  NoEncoders encoders;
  NoMotion motion;
  PlayedTrigger trigger;
  std::deque<Event> events;
  const Ports ports{nullptr, &encoders, &trigger, &motion, nullptr};
  Reflex reflex{ports, 2 * kMillisecond};
  SensorFrontEnd front_end{ports, reflex, Eigen::ArrayXd::Ones(kMostJoints), 1e-4, kSecond};
};

TEST_F(HeardTrigger, KeepsTheFirstContactOfAProbeThatBouncesWhileTheRobotBrakes) {
  trigger.set(20 * kMillisecond, true);
  listen(20, 25);
  trigger.set(26 * kMillisecond, false);
  listen(26, 32);
  trigger.set(33 * kMillisecond, true);
  listen(33, 40);
  ASSERT_TRUE(front_end.closing());
  EXPECT_EQ(front_end.closing()->time, 20 * kMillisecond);
  EXPECT_EQ(front_end.closed(), true);
}

TEST_F(HeardTrigger, TakesTheNextContactAfterTheLastOneWasForgotten) {
  trigger.set(20 * kMillisecond, true);
  listen(20, 25);
  front_end.forget_closing();
  trigger.set(26 * kMillisecond, false);
  listen(26, 32);
  trigger.set(33 * kMillisecond, true);
  listen(33, 40);
  ASSERT_TRUE(front_end.closing());
  EXPECT_EQ(front_end.closing()->time, 33 * kMillisecond);
}

TEST_F(HeardTrigger, HasTheMomentOfAnEdgeThatComesWhileItLooks) {
  trigger.arrives_meanwhile = Edge{.time = 20 * kMillisecond, .closed = true};
  listen(20, 30);
  ASSERT_TRUE(front_end.closing());
  EXPECT_EQ(front_end.closing()->time, 20 * kMillisecond);
  EXPECT_TRUE(front_end.closing()->timed);
}

}  // namespace
}  // namespace selfcal
