// Somebody else in the robot's DDS domain: pretends to be it, or commands its service.
#include <gtest/gtest.h>

#include "io/dds/messenger.h"
#include "io/dds/names.h"
#include "io/dds/robot_side.h"
#include "io/dds/senders.h"
#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

/// A session of a robot in a process of its own, after a few touches.
class Strangers : public testing::Test {
 protected:
  static CellOptions options() {
    CellOptions options;
    options.live = true;
    return options;
  }
  void SetUp() override {
    cell.start_robot();
    cell.start_service();
    ASSERT_TRUE(cell.start_session());
    ASSERT_TRUE(cell.until([&] { return cell.touches() >= 3; }));
  }
  /// The service stops for the stranger, who speaks every few milliseconds, and takes nothing of
  /// it.
  void expect_fault(const std::string& topic, const std::function<void()>& speak) {
    const std::size_t before = cell.touches();
    ASSERT_TRUE(cell.until([&] {
      speak();
      return cell.in_state("fault");
    }));
    EXPECT_NE(cell.statuses.back().why.find("two senders of " + topic), std::string::npos)
        << cell.statuses.back().why;
    EXPECT_LE(cell.touches(), before + 2) << "the touch under way and one more, at most";
    for (const TouchRecord& touch : must(cell.store()->touches(1)))
      EXPECT_TRUE(touch.outcome != TouchOutcome::taken || touch.before.counts[0] != kForged);
  }

  static constexpr std::int64_t kForged = 1'234'567'890;  // nanoradian
  Cell cell{options()};
  DdsParticipant participant = must(DdsParticipant::open(cell.domain, "stranger"));
  Wakeup wakeup;
};

TEST_F(Strangers, WhoRepliesInTheRobotsPlaceAreAFaultAndNotBelieved) {
  const auto robot = must(DdsRobotSide::open(participant, {.robot = "cell"}, wakeup));
  std::vector<RobotRequest> requests;
  expect_fault("motion replies", [&] {
    requests.clear();
    must(robot->take(requests));
    for (const RobotRequest& each : requests)
      (void)robot->reply({each.move.id, MotionReply::Outcome::done, {}});
  });
}

TEST_F(Strangers, WhoPublishJointStatesAreAFaultAndNotBelieved) {
  const auto config = must(load_config(cell.folder / "config.yaml"));
  const auto joints =
      must(DdsJointSender::open(participant, "joint_states", config.joint_names, wakeup));
  Nanoseconds stamp = 0;
  expect_fault("encoder readings", [&] {
    (void)joints->send(stamp += kMillisecond, std::vector<double>(6, 1e-9 * kForged));
  });
}

TEST_F(Strangers, WhoPublishTheTriggerAreAFaultAndNotBelieved) {
  const auto trigger = must(DdsTriggerSender::open(participant, "selfcal/cell/trigger", wakeup));
  Nanoseconds stamp = 0;
  bool closed = false;
  expect_fault("the trigger",
               [&] { (void)trigger->send(stamp += kMillisecond, closed = !closed); });
}

TEST_F(Strangers, WhoSpeakAsItsServiceAreAFaultForAsLongAsTheyAreThere) {
  auto other = must(DdsMessenger::open(participant, "cell", wakeup));
  ASSERT_TRUE(cell.until([&] { return cell.in_state("fault"); }));
  EXPECT_NE(cell.statuses.back().why.find("another service of robot cell"), std::string::npos)
      << cell.statuses.back().why;
  other.reset();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  EXPECT_TRUE(cell.command("start").accepted) << "goes on when a person says so";
}

TEST(TwoServices, OfOneRobotDoNotRunWhateverTheirFolders) {
  CellOptions options;
  options.touches = 8;
  Cell cell(options);
  const std::filesystem::path other = cell.folder / "other";
  std::filesystem::create_directory(other);
  for (const auto& file : std::filesystem::directory_iterator(cell.folder))
    if (file.is_regular_file())
      std::filesystem::copy_file(file.path(), other / file.path().filename());
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));

  Running second({"serve", other / "config.yaml", "--simulate"}, other / "log");
  EXPECT_EQ(second.wait(), kDeviceFailed);
  const std::string log = text_of(other / "log");
  EXPECT_NE(log.substr(0, log.find('\n'))
                .find("robot cell in DDS domain " + std::to_string(cell.domain) +
                      ", topics rt/selfcal/cell/..."),
            std::string::npos)
      << "the first line says where it is: " << log;
  EXPECT_NE(log.find("a service of robot cell is in DDS domain"), std::string::npos) << log;
  EXPECT_TRUE(cell.command("start").accepted) << "the first has not noticed it";
}

TEST(Commands, AreNotTakenUnlessTheConfigurationAllowsThem) {
  CellOptions options;
  options.touches = 8;
  options.commands = "{}";
  Cell cell(options);
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  for (const char* verb : {"start", "abort", "accept", "rollback"}) {
    const CommandReplyMessage reply = cell.command(verb);
    EXPECT_FALSE(reply.accepted) << verb;
    EXPECT_NE(reply.why.find("takes no commands over DDS"), std::string::npos) << reply.why;
  }
  EXPECT_NE(cell.log().find("no commands are taken over DDS"), std::string::npos);
}

TEST(Commands, AreTakenByNameAlone) {
  CellOptions options;
  options.touches = 8;
  options.commands = "{over: loopback, allow: [start, abort]}";
  Cell cell(options);
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  EXPECT_NE(cell.command("accept").why.find("does not take 'accept'"), std::string::npos);
  EXPECT_TRUE(cell.command("abort").accepted);
  EXPECT_NE(cell.log().find("start, abort may be commanded by programs on this computer"),
            std::string::npos);
}

TEST(Commands, OverLoopbackNeedDdsConfinedToThisComputer) {
  CellOptions options;
  options.touches = 8;
  Cell cell(options);
  const std::string given = std::getenv("CYCLONEDDS_URI");
  setenv("CYCLONEDDS_URI", "<General><AllowMulticast>false</AllowMulticast></General>", 1);
  cell.start_service();
  setenv("CYCLONEDDS_URI", given.c_str(), 1);
  EXPECT_EQ(cell.wait_for_service(), kBadInput);
  EXPECT_NE(cell.log().find("DDS is not confined to this computer"), std::string::npos)
      << cell.log();
}

}  // namespace
}  // namespace selfcal
