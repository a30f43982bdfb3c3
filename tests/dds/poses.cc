// Poses asked for on the wire, and their answers.
#include "io/dds/poses.h"

#include <gtest/gtest.h>

#include "io/dds/convert.h"
#include "io/dds/messenger.h"
#include "io/dds/motion.h"
#include "io/dds/names.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using DdsPosesTest = DdsTest;

TEST_F(DdsPosesTest, AreAnsweredOnceEach) {
  const auto poses = must(DdsPoses::open(participant, "RX-90", wakeup));
  auto asking = must(DdsWriter<dds::PoseRequest>::open(
      participant, robot_topic("RX-90", "pose_request"), kExchange));
  auto replies = must(
      DdsReader<dds::PoseReply>::open(participant, robot_topic("RX-90", "pose_reply"), kReplies));
  ASSERT_TRUE(eventually([&] { return asking.matched() > 0 && replies.matched() > 0; }));
  double place[] = {0.1, -0.2, 0.3}, turn[] = {1, 0, 0, 0}, near[] = {0.5, 0.25};
  char id[] = "a";
  dds::PoseRequest request{};
  request.id_ = id;
  request.position_ = {3, 3, place, false};
  request.orientation_ = {4, 4, turn, false};
  request.near_ = {2, 2, near, false};
  request.payload_ = 2.5;
  request.temperature_ = 31;
  ASSERT_TRUE(asking.write(request));
  PoseRequestMessage heard;
  int asked = 0;
  ASSERT_TRUE(eventually([&] {
    poses->answer([&](const PoseRequestMessage& each) {
      heard = each;
      ++asked;
      PoseReplyMessage reply;
      reply.status = "reached";
      reply.q = {1.5, -0.5};
      reply.model = "session 2";
      return reply;
    });
    return asked > 0;
  }));
  EXPECT_EQ(heard.position, (std::vector<double>{0.1, -0.2, 0.3}));
  EXPECT_EQ(heard.near, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(heard.payload, 2.5);
  EXPECT_EQ(heard.temperature, 31);
  EXPECT_TRUE(heard.payload_centre.empty());
  std::vector<std::string> told;
  std::vector<double> q;
  ASSERT_TRUE(eventually([&] {
    (void)replies.take([&](const dds::PoseReply& reply) {
      told = {reply.id_, reply.status_, reply.model_};
      q.assign(reply.q_._buffer, reply.q_._buffer + reply.q_._length);
    });
    return !told.empty();
  }));
  EXPECT_EQ(told, (std::vector<std::string>{"a", "reached", "session 2"}));
  EXPECT_EQ(q, (std::vector<double>{1.5, -0.5}));
  EXPECT_EQ(asked, 1);
}

/// The first of more messages than any reader keeps that was not sent; 0 when all were.
template <class T>
int first_not_sent(const DdsParticipant& participant, const std::string& topic, const T& message) {
  auto writer = must(DdsWriter<T>::open(participant, topic, kExchange));
  Wakeup wakeup;
  EXPECT_TRUE(eventually(wakeup, [&] { return writer.matched() > 0; }));
  for (int i = 1; i <= 2 * kMostKept; ++i)
    if (!writer.write(message)) return i;
  return 0;
}

// A reader that has no room left holds up the thread that receives everything else, too.
TEST_F(DdsPosesTest, AndWhateverElseTheServiceIsSentAlwaysFindRoom) {
  const auto poses = must(DdsPoses::open(participant, "r", wakeup));
  const auto messenger = must(DdsMessenger::open(participant, "r", wakeup));
  const auto motion = must(DdsMotion::open(participant, "r", wakeup));
  char text[] = "";
  dds::PoseRequest request{};
  request.id_ = text;
  const dds::Command command{.id_ = text, .verb_ = text, .from_ = text};
  const dds::MotionReply reply{.id_ = 1, .outcome_ = text, .why_ = text};
  EXPECT_EQ(first_not_sent(participant, robot_topic("r", "pose_request"), request), 0);
  EXPECT_EQ(first_not_sent(participant, robot_topic("r", "command"), command), 0);
  EXPECT_EQ(first_not_sent(participant, robot_topic("r", "motion_reply"), reply), 0);
}

}  // namespace
}  // namespace selfcal
