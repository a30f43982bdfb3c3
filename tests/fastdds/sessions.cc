// Whole sessions with robots whose drivers stand on Fast DDS, which most installations of ROS 2
// use: the service, and the bridge, in processes of their own on Cyclone DDS; every byte on Fast
// DDS's side is written and read by hand (cdr.h).
#include <gmock/gmock.h>

#include "tests/fastdds/cdr.h"
#include "tests/fastdds/robot.h"
#include "tests/support/bridged_session.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

constexpr const char* kArm = "/arm/follow_joint_trajectory";

CellOptions options_of(const std::string& id) {
  CellOptions options;
  options.id = id + std::to_string(getpid());
  options.live = true;
  options.touches = 12;
  options.domain = open_domain();
  return options;
}

std::string service_type(const std::string& name) {
  return "selfcal_msgs::msg::dds_::" + name + "_";
}

/// Waits for a message that comes to a reader of Fast DDS.
std::string next(FastReader& reader, Cell& cell) {
  std::string bytes;
  EXPECT_TRUE(cell.until(
      [&] {
        for (const auto& message : reader.take()) bytes = message.bytes;
        return !bytes.empty();
      },
      kLimit));
  return bytes;
}

/// Says a command until a reply comes, as every client must: of two that have found each other the
/// one may know it before the other does, and what it writes meanwhile is lost. The service does
/// once what is said again under the same id.
std::string answer(FastWriter& command, const std::string& said, FastReader& replies, Cell& cell) {
  std::string reply;
  Nanoseconds next_time = 0;
  EXPECT_TRUE(cell.until(
      [&] {
        if (monotonic_now() >= next_time) {
          command.write(said);
          next_time = monotonic_now() + kSecond / 4;
        }
        for (const auto& message : replies.take()) reply = message.bytes;
        return !reply.empty();
      },
      kLimit));
  return reply;
}

/// Status.msg up to its state.
struct SeenStatus {
  explicit SeenStatus(const std::string& bytes) {
    CdrIn in(bytes);
    (void)in.time();
    robot = in.text();
    (void)in.text();  // the model's hash
    version = in.text();
    state = in.text();
    for (int i = 0; i < 3; ++i) (void)in.text();  // phase, hardware, why
    (void)in.number<std::int64_t>();              // the session
    (void)in.text();                              // its kind
    active = in.text();
    (void)in.time();  // since when
    candidate = in.number<std::uint8_t>() != 0;
    (void)in.time();  // next due
    (void)in.number<double>();
    whole = in.ended();
  }
  std::string robot, version, state, active;
  bool candidate = false, whole = false;
};

TEST(FastDds, ADriverCalibratesItsRobotAndSeesWhatTheServiceTells) {
  Cell cell(options_of("fast"));
  FastDriver robot(cell);
  FastPeer watcher(cell.domain);
  const std::string prefix = "rt/selfcal/" + cell.options.id + "/";
  FastReader results = watcher.reader({prefix + "result", service_type("Result"), true, true});
  FastReader progress = watcher.reader({prefix + "progress", service_type("Progress")});
  FastWriter command = watcher.writer({prefix + "command", service_type("Command")});
  FastReader replies = watcher.reader({prefix + "command_reply", service_type("CommandReply")});
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }, kLimit));

  // Who comes late reads the last status, as ROS 2 does with transient local durability.
  FastPeer late(cell.domain);
  FastReader status = late.reader({prefix + "status", service_type("Status"), true, true});
  const SeenStatus idle(next(status, cell));
  EXPECT_EQ(idle.robot, cell.options.id);
  EXPECT_EQ(idle.version, SELFCAL_VERSION);
  EXPECT_EQ(idle.state, "idle");
  EXPECT_EQ(idle.active, "factory");
  EXPECT_FALSE(idle.candidate);
  EXPECT_TRUE(idle.whole);

  const std::string reply =
      answer(command, CdrOut().text("1").text("start").text("Fast DDS").bytes(), replies, cell);
  CdrIn answered(reply);
  EXPECT_EQ(answered.text(), "1");
  EXPECT_EQ(answered.text(), "start");
  EXPECT_EQ(answered.number<std::uint8_t>(), 1) << answered.text();

  ASSERT_TRUE(cell.until([&] { return !cell.results.empty() || cell.in_state("fault"); }));
  ASSERT_FALSE(cell.in_state("fault")) << cell.statuses.back().why << cell.log();
  const ResultMessage& told = cell.results.back();
  const std::string bytes = next(results, cell);
  CdrIn result(bytes);
  (void)result.time();
  EXPECT_EQ(result.text(), cell.options.id);
  (void)result.text();
  EXPECT_EQ(result.number<std::int64_t>(), 1);
  EXPECT_EQ(result.text(), "full");
  EXPECT_EQ(result.text(), told.answer);
  EXPECT_EQ(result.text(), told.decision);
  (void)result.text();
  EXPECT_EQ(result.number<double>(), told.p_value);
  EXPECT_EQ(result.number<double>(), told.check_before);
  EXPECT_EQ(result.number<double>(), told.check_after);
  EXPECT_EQ(told.answer, "improved");
  std::size_t heard = 0;  // touches; before the first there is no session yet
  for (const auto& message : progress.take()) {
    CdrIn in(message.bytes);
    (void)in.time();
    EXPECT_EQ(in.text(), cell.options.id);
    if (in.number<std::int64_t>() == 0) continue;
    EXPECT_EQ(in.text(), "full");
    ++heard;
  }
  EXPECT_GE(heard, 60u);
  std::printf("a driver on Fast DDS: %d moves, %d stopped by touches; %s, %.3g to %.3g mm\n",
              robot.moves(), robot.stopped(), told.answer.c_str(), 1e3 * told.check_before,
              1e3 * told.check_after);
  EXPECT_GE(robot.stopped(), 60);
}

TEST(FastDds, AControllerCalibratesItsRobotThroughTheBridge) {
  Cell cell(options_of("fastbridge"));
  FastController robot(cell, kArm, "touch");
  const std::size_t taken = calibrate_through_bridge(cell, kArm);
  std::printf("a controller on Fast DDS: %d goals, %d cancelled\n", robot.moves(), robot.stopped());
  EXPECT_GE(robot.stopped(), static_cast<int>(taken)) << "each touch ends by a cancelled goal";
}

TEST(FastDds, AControllersRefusalIsToldByName) {
  Cell cell(options_of("fastrefuses"));
  FastController robot(cell, kArm, "touch");
  robot.refuse();
  Running bridge({"bridge", cell.folder / "config.yaml", "--action", kArm, "--touch", "touch"},
                 cell.folder / "bridge.log");
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return cell.in_state("fault"); }));
  EXPECT_THAT(cell.statuses.back().why,
              HasSubstr("/arm/follow_joint_trajectory rejected the goal"));
  EXPECT_EQ(robot.moves(), 0);
}

// What the other tests would not notice if DDS matched by the topic's name alone.
TEST(FastDds, MeetsNobodyUnderAnotherTypesName) {
  Cell cell(options_of("fasttypes"));
  FastPeer peer(cell.domain);
  const std::string topic = "rt/selfcal/" + cell.options.id + "/status";
  FastReader wrong = peer.reader({topic, "selfcal_msgs::msg::Status", true, true});
  FastPeer other(cell.domain);
  FastReader right = other.reader({topic, service_type("Status"), true, true});
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return right.matched() == 1; }, kLimit));
  EXPECT_TRUE(SeenStatus(next(right, cell)).whole);
  EXPECT_EQ(wrong.matched(), 0);
  EXPECT_TRUE(wrong.take().empty());
}

}  // namespace
}  // namespace selfcal
