// Two processes over the loopback interface: a peer that comes, goes and comes back.

#include <gtest/gtest.h>

#include "io/dds/clients/commander.h"
#include "io/dds/clients/monitor.h"
#include "io/dds/encoders.h"
#include "io/dds/motion.h"
#include "io/dds/trigger.h"
#include "tests/dds/peer.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class DdsProcesses : public DdsTest {
 protected:
  // Whether a reply to request `id` came.
  bool replied(DdsMotion& motion, std::uint64_t id) {
    return eventually([&] {
      std::vector<MotionReply> replies;
      must(motion.take(replies));
      return !replies.empty() && replies.back().id == id;
    });
  }

  std::shared_ptr<TimeMapping> mapping = std::make_shared<TimeMapping>();
};

TEST_F(DdsProcesses, MeasureMoveAndTouch) {
  const auto encoders = must(DdsEncoders::open(participant, {.joints = {"b", "a"}}, mapping));
  const auto trigger = must(DdsTrigger::open(participant, {}, mapping, wakeup));
  const auto motion = must(DdsMotion::open(participant, "r", wakeup));
  Peer robot("robot", domain);
  std::vector<EncoderSample> samples;
  ASSERT_TRUE(eventually([&] {
    must(encoders->take(samples));
    return samples.size() >= 100 && trigger->closed() == false && motion->connected();
  }));
  EXPECT_EQ(samples.back().counts[0], 2'000'000'000);
  // The first message was under way for less than this, and the clocks are the same.
  EXPECT_NEAR(seconds(monotonic_now() - samples.back().time), 0, 0.5);

  const Nanoseconds asked = monotonic_now();
  must(motion->request({.id = 7, .label = "", .q = {}}));
  EXPECT_TRUE(replied(*motion, 7));
  const Nanoseconds answered = monotonic_now();
  std::vector<Edge> edges;
  ASSERT_TRUE(eventually([&] {
    must(trigger->take(edges));
    return !edges.empty();
  }));

  EXPECT_EQ(edges.size(), 1);
  EXPECT_TRUE(edges[0].closed);
  EXPECT_GT(edges[0].time, asked - kSecond / 2);
  EXPECT_LT(edges[0].time, answered + kSecond / 2);
  must(motion->stop("enough"));
  EXPECT_TRUE(replied(*motion, 7));
  EXPECT_EQ(robot.end(), 0);
}

TEST_F(DdsProcesses, LoseARobotThatIsKilledAndFindItAgain) {
  const auto encoders = must(DdsEncoders::open(participant, {.joints = {"a", "b"}}, mapping));
  const auto trigger = must(DdsTrigger::open(participant, {}, mapping, wakeup));
  const auto motion = must(DdsMotion::open(participant, "r", wakeup));
  std::vector<EncoderSample> samples;
  for (std::uint64_t life = 1; life <= 2; ++life) {
    Peer robot("robot", domain);
    samples.clear();
    ASSERT_TRUE(eventually([&] {
      must(encoders->take(samples));
      return samples.size() >= 10 && trigger->closed() == false && motion->connected();
    }));
    must(motion->request({.id = life, .label = "", .q = {}}));
    EXPECT_TRUE(replied(*motion, life));

    robot.kill();
    EXPECT_TRUE(eventually([&] {
      must(encoders->take(samples));
      return encoders->senders() == 0 && !motion->connected() && !trigger->closed();
    }));
    EXPECT_FALSE(motion->request({.id = 100, .label = "", .q = {}}));
  }
  EXPECT_EQ(encoders->dropped(), 0);
}

TEST_F(DdsProcesses, WatchAndCommandAServiceThatComesBack) {
  const auto monitor = must(DdsMonitor::open(participant, "r", wakeup));
  const auto commander = must(DdsCommander::open(participant, "r"));
  for (int life = 1; life <= 2; ++life) {
    Peer service("service", domain);
    std::vector<StatusMessage> status;
    std::vector<ResultMessage> results;
    EXPECT_TRUE(eventually([&] {
      monitor->take(status);
      monitor->take(results);
      return !status.empty() && !results.empty();
    }));
    ASSERT_FALSE(results.empty());
    EXPECT_EQ(results[0].json.size(), 300'000);
    const auto reply =
        commander->send({.id = DdsCommander::new_id(), .verb = "start", .from = "a test"}, kLimit);
    ASSERT_TRUE(reply) << reply.error().what;
    EXPECT_TRUE(reply->accepted);

    if (life == 1) {
      service.kill();
      EXPECT_TRUE(eventually([&] { return !monitor->connected(); }));
    } else {
      EXPECT_EQ(service.end(), 0);
    }
  }
}

// Each program is new to the service, and its command may be the first thing it says.
TEST_F(DdsProcesses, CommandAServiceThatHasJustBeenFound) {
  Peer service("service", domain);
  for (int i = 0; i < 10; ++i) {
    const auto newcomer = must(DdsParticipant::open(domain, "newcomer"));
    const auto commander = must(DdsCommander::open(newcomer, "r"));

    const auto reply =
        commander->send({.id = DdsCommander::new_id(), .verb = "check", .from = ""}, kLimit);

    ASSERT_TRUE(reply) << reply.error().what;
    EXPECT_TRUE(reply->accepted);
  }
  EXPECT_EQ(service.end(), 0);
}

}  // namespace
}  // namespace selfcal
