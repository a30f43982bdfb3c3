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

class NotedMotion final : public Motion {
 public:
  Result<void> request(const MotionRequest& request) override {
    noted.push_back("move " + std::to_string(request.id));
    return {};
  }
  Result<void> stop(const std::string& why) override {
    noted.push_back("stop: " + why);
    return {};
  }
  Result<void> take(std::vector<MotionReply>&) override { return {}; }

  std::vector<std::string> noted;
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
  NotedMotion motion;
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

/// A move that ends at a contact.
MotionRequest to_contact(std::uint64_t id) {
  MotionRequest request;
  request.id = id;
  return request;
}

TEST_F(HeardTrigger, StopsAMoveToAContactThatIsThereBeforeItIsAskedFor) {
  trigger.set(20 * kMillisecond, true);
  listen(20, 25);
  ASSERT_TRUE(reflex.request(to_contact(7), true));
  EXPECT_EQ(motion.noted, (std::vector<std::string>{"move 7", "stop: touched"}));
  EXPECT_TRUE(reflex.has_stopped(7));
}

TEST_F(HeardTrigger, StopsAMoveToAContactOnceItComes) {
  ASSERT_TRUE(reflex.request(to_contact(7), true));
  EXPECT_EQ(motion.noted, std::vector<std::string>{"move 7"});
  trigger.set(20 * kMillisecond, true);
  listen(20, 25);
  EXPECT_EQ(motion.noted, (std::vector<std::string>{"move 7", "stop: touched"}));
  ASSERT_TRUE(reflex.request(to_contact(8), std::nullopt));  // away from it, which nothing guards
  EXPECT_EQ(motion.noted.back(), "move 8");
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
