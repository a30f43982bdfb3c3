// Commands to a service and their replies, in one process.

#include <gmock/gmock.h>

#include <thread>

#include "io/dds/clients/commander.h"
#include "io/dds/messenger.h"
#include "io/dds/names.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class DdsCommands : public DdsTest {
 protected:
  std::unique_ptr<DdsMessenger> service = must(DdsMessenger::open(participant, "r", wakeup));
};

TEST_F(DdsCommands, GetTheirReply) {
  const auto commander = must(DdsCommander::open(participant, "r"));
  Result<CommandReplyMessage> reply;
  std::thread asking(
      [&] { reply = commander->send({.id = "7", .verb = "start", .from = "a test"}, kLimit); });

  std::vector<CommandMessage> commands;
  EXPECT_TRUE(eventually([&] { return service->take(commands), !commands.empty(); }));
  service->reply({.id = "7", .verb = "start", .accepted = false, .why = "a session runs"});
  asking.join();

  ASSERT_TRUE(reply) << reply.error().what;
  EXPECT_EQ(commands.at(0).verb, "start");
  EXPECT_EQ(commands.at(0).from, "a test");
  EXPECT_FALSE(reply->accepted);
  EXPECT_EQ(reply->verb, "start");
  EXPECT_EQ(reply->why, "a session runs");
}

TEST_F(DdsCommands, MissAServiceThatIsNotThere) {
  service.reset();
  const auto commander = must(DdsCommander::open(participant, "r"));

  const auto reply = commander->send({.id = "1", .verb = "start", .from = ""}, 20 * kMillisecond);

  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error().exit_status, kDeviceFailed);
  EXPECT_THAT(reply.error().what, HasSubstr("no service of robot r"));
}

TEST_F(DdsCommands, ReportAServiceThatDoesNotReply) {
  const auto commander = must(DdsCommander::open(participant, "r"));

  const auto reply = commander->send({.id = "1", .verb = "start", .from = ""}, kSecond / 2);

  ASSERT_FALSE(reply);
  EXPECT_THAT(reply.error().what, HasSubstr("does not reply"));
}

TEST_F(DdsCommands, AreObeyedOnceWhenRepeatedAndAnsweredAgain) {
  auto commands =
      must(DdsWriter<dds::Command>::open(participant, robot_topic("r", "command"), kExchange));
  auto replies = must(DdsReader<dds::CommandReply>::open(
      participant, robot_topic("r", "command_reply"), kExchange, &wakeup));
  char id[] = "5", verb[] = "start", from[] = "";
  const dds::Command command{.id_ = id, .verb_ = verb, .from_ = from};
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0 && replies.matched() > 0; }));
  std::vector<CommandMessage> taken;

  must(commands.write(command));
  ASSERT_TRUE(eventually([&] { return service->take(taken), !taken.empty(); }));
  must(commands.write(command));  // no reply yet
  service->take(taken);
  service->reply({.id = "5", .verb = "start", .accepted = true, .why = ""});
  must(commands.write(command));
  service->take(taken);

  EXPECT_EQ(taken.size(), 1);
  int replied = 0;
  must(replies.take([&](const dds::CommandReply& reply) { replied += reply.accepted_; }));
  EXPECT_EQ(replied, 2);
}

TEST_F(DdsCommands, AreRefusedFromTheSeventeenthOfASecondOn) {
  auto commands =
      must(DdsWriter<dds::Command>::open(participant, robot_topic("r", "command"), kExchange));
  auto replies = must(DdsReader<dds::CommandReply>::open(
      participant, robot_topic("r", "command_reply"), kExchange, &wakeup));
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0 && replies.matched() > 0; }));
  char verb[] = "check", from[] = "";
  for (int i = 0; i < 20; ++i) {
    std::string id = std::to_string(i);
    must(commands.write({.id_ = id.data(), .verb_ = verb, .from_ = from}));
  }
  std::vector<CommandMessage> taken;

  service->take(taken);

  EXPECT_EQ(taken.size(), 16);
  std::vector<std::string> refused;
  must(replies.take([&](const dds::CommandReply& reply) {
    EXPECT_FALSE(reply.accepted_);
    EXPECT_THAT(reply.why_, HasSubstr("more than 16 commands in a second"));
    refused.emplace_back(reply.id_);
  }));
  EXPECT_THAT(refused, ElementsAre("16", "17", "18", "19"));
  EXPECT_EQ(service->refused(), 4);
}

TEST_F(DdsCommands, AreRefusedWhenLongerThanAnyIs) {
  auto commands =
      must(DdsWriter<dds::Command>::open(participant, robot_topic("r", "command"), kExchange));
  auto replies = must(DdsReader<dds::CommandReply>::open(
      participant, robot_topic("r", "command_reply"), kExchange, &wakeup));
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0 && replies.matched() > 0; }));
  std::string usual = "start", most(DdsMessenger::kMostText, 'x'), more = most + "x";
  std::vector<CommandMessage> taken;

  must(commands.write({.id_ = more.data(), .verb_ = usual.data(), .from_ = usual.data()}));
  must(commands.write({.id_ = usual.data(), .verb_ = more.data(), .from_ = usual.data()}));
  must(commands.write({.id_ = usual.data(), .verb_ = usual.data(), .from_ = more.data()}));
  must(commands.write({.id_ = most.data(), .verb_ = usual.data(), .from_ = usual.data()}));
  service->take(taken);

  ASSERT_EQ(taken.size(), 1);
  EXPECT_EQ(taken[0].id, most);
  EXPECT_EQ(service->refused(), 3);
  int refused = 0;
  must(replies.take([&](const dds::CommandReply& reply) {
    ++refused;
    EXPECT_THAT(reply.why_, HasSubstr("longer than any command"));
    EXPECT_LE(std::string(reply.id_).size(), most.size());
  }));
  EXPECT_EQ(refused, 3);
}

TEST_F(DdsCommands, LetAnAbortThroughAFloodOfOthers) {
  auto commands =
      must(DdsWriter<dds::Command>::open(participant, robot_topic("r", "command"), kExchange));
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0; }));
  char start[] = "start", abort[] = "abort", from[] = "";
  std::vector<CommandMessage> taken;
  for (int i = 0; i < 100; ++i) {
    std::string id = std::to_string(i);
    must(commands.write({.id_ = id.data(), .verb_ = start, .from_ = from}));
    service->take(taken);
  }
  char id[] = "last";
  must(commands.write({.id_ = id, .verb_ = abort, .from_ = from}));

  EXPECT_TRUE(eventually([&] {
    service->take(taken);
    return !taken.empty() && taken.back().verb == "abort";
  }));
}

}  // namespace
}  // namespace selfcal
