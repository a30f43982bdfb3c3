// How the service behaves towards those who watch and command it, and when its robot is gone.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

CellOptions small() {
  CellOptions options;
  options.touches = 8;
  return options;
}

CellOptions small_and_live() {
  CellOptions options = small();
  options.live = true;
  return options;
}

/// Starts the robot, the service and a session, and waits until five touches are made.
bool makes_five_touches(Cell& cell) {
  cell.start_robot();
  cell.start_service();
  return cell.start_session() && cell.until([&] { return cell.touches() >= 5; });
}

TEST(Manners, ALateJoinerSeesTheLastResultAndAPersonDecides) {
  CellOptions options = small();
  options.automatic = false;
  Cell cell(options);
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return cell.in_state("awaiting-acceptance"); }));
  EXPECT_EQ(cell.results.back().decision, "candidate");
  EXPECT_EQ(cell.statuses.back().active, "factory") << "nothing is applied behind anyone's back";

  Wakeup wakeup;
  const auto participant = must(DdsParticipant::open(cell.domain, "late"));
  const auto late = must(DdsMonitor::open(participant, "cell", wakeup));
  std::vector<ResultMessage> results;
  ASSERT_TRUE(eventually(wakeup, [&] {
    late->take(results);
    return !results.empty();
  }));
  EXPECT_EQ(results.back().session, 1);
  EXPECT_FALSE(results.back().json.empty());

  EXPECT_EQ(cell.command("start").why, "a result waits for acceptance: accept or reject it first");
  EXPECT_TRUE(cell.command("accept").accepted);
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  EXPECT_EQ(cell.statuses.back().active, "session 1");
  const CommandReplyMessage back = cell.command("rollback");
  EXPECT_TRUE(back.accepted);
  EXPECT_EQ(back.why,
            "factory is active now; session 1 was rolled back and is not used again by itself");
  ASSERT_TRUE(cell.until([&] { return cell.statuses.back().active == "factory"; }));
  EXPECT_TRUE(cell.until([&] { return cell.results.back().decision == "rolled-back"; }));
  const CommandReplyMessage again = cell.command("rollback");
  EXPECT_FALSE(again.accepted) << "never forth: session 1 was given up";
  EXPECT_NE(again.why.find("active: factory"), std::string::npos) << again.why;
}

TEST(Manners, AbortStopsTheRobotAndKeepsWhatWasCollected) {
  Cell cell(small_and_live());
  ASSERT_TRUE(makes_five_touches(cell));
  ASSERT_TRUE(cell.command("abort").accepted);
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  const auto store = cell.store();
  EXPECT_EQ(must(store->session(1)).state, SessionState::aborted);
  EXPECT_GE(must(store->touches(1)).size(), 5U);
  EXPECT_TRUE(cell.results.empty());
  EXPECT_FALSE(cell.command("abort").accepted) << "nothing runs any more";
}

TEST(Manners, RefusesAWrongCommandWithTheReason) {
  Cell cell(small());
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  EXPECT_EQ(
      cell.command("dance").why,
      "no command is called 'dance'; known: start, check, diagnose, done, abort, accept, reject, "
      "rollback");
  EXPECT_EQ(cell.command("accept").why, "no result waits for acceptance");
  EXPECT_FALSE(cell.command("rollback").accepted);
  EXPECT_FALSE(cell.command("check").accepted) << "no session to compare with";
}

TEST(Manners, TwoRobotsInOneDomainDoNotMix) {
  CellOptions options = small();
  options.id = "left";
  Cell left(options);
  options.id = "right";
  options.seed = 3;
  options.domain = left.domain;
  Cell right(options);
  left.start_service();
  right.start_service();
  ASSERT_TRUE(left.until([&] { return left.in_state("idle"); }));
  ASSERT_TRUE(right.until([&] { return right.in_state("idle"); }));
  ASSERT_TRUE(left.command("start").accepted);
  ASSERT_TRUE(left.until([&] { return !left.results.empty() && left.in_state("idle"); }));
  right.listen();
  EXPECT_TRUE(right.results.empty());
  EXPECT_TRUE(right.progress.empty());
  for (const StatusMessage& each : right.statuses) EXPECT_EQ(each.robot, "right");
  EXPECT_TRUE(must(right.store()->sessions(1)).empty());
}

TEST(Manners, SaysThatTheRobotIsGoneAndGoesOnByCommandWhenItIsBack) {
  Cell cell(small_and_live());
  ASSERT_TRUE(makes_five_touches(cell));
  cell.kill_robot();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("fault"); }));
  EXPECT_NE(cell.statuses.back().why.find("no encoder reading"), std::string::npos)
      << cell.statuses.back().why;
  ASSERT_TRUE(cell.until([&] {
    for (const HealthMessage& line : cell.health.back().lines)
      if (line.name == "selfcal: encoders" && line.level == Health::error) return true;
    return false;
  }));
  cell.start_robot();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  EXPECT_TRUE(cell.results.empty()) << "no motion without a person after a fault";
  ASSERT_TRUE(cell.command("start").accepted);
  ASSERT_TRUE(cell.until([&] { return !cell.results.empty(); }));
  EXPECT_EQ(cell.results.back().session, 1) << "the same session, resumed";
  EXPECT_EQ(cell.results.back().answer, "improved");
}

TEST(Manners, ChecksQuicklyAndCalibratesOnlyWhenTheActiveModelFails) {
  Cell cell(CellOptions{});
  // One healthy robot in a hundred would be doubted by chance, and this one be it or not.
  std::string config = text_of(cell.folder / "config.yaml");
  replace(config, "schedule: {}", "schedule: {check_p: 1.0e-6}");
  std::ofstream(cell.folder / "config.yaml") << config;
  cell.start_service();
  ASSERT_TRUE(cell.start_session());
  ASSERT_TRUE(cell.until([&] { return !cell.results.empty() && cell.in_state("idle"); }));
  ASSERT_TRUE(cell.command("check").accepted);
  ASSERT_TRUE(cell.until([&] { return cell.results.size() >= 2 && cell.in_state("idle"); }));
  ASSERT_EQ(cell.results.back().kind, "check");
  ASSERT_EQ(cell.results.back().answer, "explained") << cell.results.back().why;
  EXPECT_GE(cell.results.back().touches, 12U);

  // The robot has had a collision: a joint's zero is off by 1 mrad.
  cell.kill_service();
  const auto path = cell.folder / "rx90_cell.scenario.yaml";
  std::string changed = text_of(path);
  const double truth =
      cell.machine()->truth().xi[find_parameter(cell.machine()->robot(), "theta3")];
  changed.replace(changed.find("errors:"), 7,
                  "errors:\n  parameters: {theta3: " + std::to_string(truth + 1e-3) + "}");
  std::ofstream(path) << changed;
  cell.statuses.clear();
  cell.results.clear();
  cell.start_service();
  ASSERT_TRUE(cell.until([&] { return cell.in_state("idle"); }));
  ASSERT_TRUE(cell.command("check").accepted);
  ASSERT_TRUE(cell.until([&] {
    return !cell.results.empty() && cell.results.back().kind == "full" &&
           cell.results.back().session == 4 && cell.in_state("idle");
  }));
  const auto store = cell.store();
  EXPECT_EQ(must(store->result(3))->answer, ResultAnswer::not_explained);
  EXPECT_EQ(must(store->result(4))->decision, ResultDecision::applied)
      << must(store->result(4))->why;
  EXPECT_NEAR(must(store->result(4))->check_after, 2e-5, 1e-5);
}

}  // namespace
}  // namespace selfcal
