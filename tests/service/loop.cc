// The loop around a robot of the test's, whose time passes in the service's turns: what begins by
// itself while the robot is at other work, and what is left of a session that did not begin.
#include <gmock/gmock.h>
#include <unistd.h>

#include "app/service/loop/service.h"
#include "io/files/robot_file.h"
#include "tests/io/store_content.h"
#include "tests/io/store_records.h"
#include "tests/service/cell.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Stands at home or swings about it, and does nothing that it is asked, though it may say so.
struct BusyRobot final : Clock, EncoderSource, TouchTrigger, Motion {
  Nanoseconds now() override { return time; }
  std::int64_t unix_ms() override { return 1'790'000'000'000 + time / kMillisecond; }
  /// A fifth of a millisecond is twenty: what is planned meanwhile takes its time.
  void wait(Nanoseconds) override {
    usleep(200);
    time += 20 * kMillisecond;
  }
  const std::vector<EncoderScale>& scales() const override { return counts; }
  Result<void> take(std::vector<EncoderSample>& out) override {
    EncoderSample sample{.time = time, .joints = 6};
    for (int j = 0; j < 6; ++j) sample.counts[j] = std::llround(home[j] / counts[j].step);
    if (working) sample.counts[0] += (++swing % 100) * 1000;
    out.push_back(sample);
    return {};
  }
  std::uint64_t dropped() const override { return 0; }
  std::optional<bool> closed() override { return touching; }
  Result<void> take(std::vector<Edge>&) override { return {}; }
  Result<void> request(const MotionRequest& request) override {
    asked.push_back(request.kind);
    if (obeys) replies.push_back({request.id, MotionReply::Outcome::done, ""});
    return {};
  }
  Result<void> stop(const std::string&) override {
    ++stops;
    if (when_stopped) when_stopped();
    return {};
  }
  Result<void> take(std::vector<MotionReply>& out) override {
    out.insert(out.end(), replies.begin(), replies.end());
    replies.clear();
    return {};
  }
  int senders() const override { return 1; }
  std::uint64_t strange() const override { return 0; }

  Nanoseconds time = 1000 * kSecond;
  std::vector<EncoderScale> counts{6, EncoderScale{1e-6, 0}};
  double home[6] = {0, -0.6, 0.9, 0, 1.2, 0};
  bool working = false, touching = false, obeys = false;
  int swing = 0, stops = 0;
  std::function<void()> when_stopped;
  std::vector<MotionReply> replies;
  std::vector<MoveKind> asked;
};

/// Commands as the test says them.
struct Person final : Messenger {
  void publish(const StatusMessage&) override {}
  void publish(const ProgressMessage&) override {}
  void publish(const ResultMessage&) override {}
  void publish(const std::vector<HealthMessage>&, const std::string&) override {}
  void reply(const CommandReplyMessage& reply) override { replies.push_back(reply); }
  void take(std::vector<CommandMessage>& out) override {
    out.insert(out.end(), said.begin(), said.end());
    said.clear();
  }
  std::uint64_t refused() const override { return 0; }
  std::uint64_t unsent() const override { return 0; }
  void say(const std::string& verb) {
    said.push_back({.id = verb, .verb = verb, .from = "a test"});
  }

  std::vector<CommandMessage> said;
  std::vector<CommandReplyMessage> replies;
};

class Loop : public testing::Test {
 protected:
  Config config(const CellKeys& more = {}) const {
    CellKeys keys{{"state", scratch.folder().string()},
                  {"sets.touches", "8"},
                  {"limits.planning", "3600"},
                  {"commands.over", "loopback"},
                  {"commands.allow", "[start, done, abort]"}};
    for (const auto& [key, value] : more) keys[key] = value;
    return must(load_cell(keys));
  }
  /// The service begins, or begins anew.
  void start(Config config) {
    service.reset();
    journal.reset();
    store = opened(scratch.folder());
    journal = std::make_unique<Journal>(opened(scratch.folder()));
    Models models = must(Models::load(config.robot, *store));
    service.emplace(std::move(config), Ports{&robot, &robot, &robot, &robot}, person, *store,
                    *journal, std::move(models), "");
  }
  const ExtendedState& state() const { return service->extended_state(); }
  bool turning(const std::function<bool()>& holds) {
    for (const Nanoseconds end = robot.time + 3600 * kSecond; robot.time < end; service->turn())
      if (holds()) return true;
    ADD_FAILURE() << to_string(state().state) << ": " << state().why;
    return false;
  }
  bool comes_to(ServiceState wanted) {
    return turning([&] { return state().state == wanted; });
  }
  void turn_for(Nanoseconds time) {
    for (const Nanoseconds end = robot.time + time; robot.time < end;) service->turn();
  }

  /// Beside the service, which may be writing.
  void change_store(const std::string& sql) const {
    with_sqlite(scratch.folder() / "selfcal.db", "PRAGMA busy_timeout = 5000;" + sql);
  }

  const Scratch scratch;
  BusyRobot robot;
  Person person;
  std::unique_ptr<Store> store;
  std::unique_ptr<Journal> journal;
  std::optional<Service> service;
};

/// A session that an earlier life has left before a touch with the payload.
void leave_loaded_session(Store& store, const Config& config,
                          const std::vector<EncoderScale>& scales) {
  SessionRecord record;
  record.kind = "cause";
  record.model_hash = model_hash(*config.robot);
  record.config = decoding_text(config, scales);
  record.config_hash = config_hash(config, scales);
  StepRecord step;
  step.set = "table";
  step.loaded = true;
  step.start = step.touch = step.end = {0.3, -0.6, 0.9, 0, 1.2, 0};
  must(store.begin(record, {step}));
}

/// A result that an earlier life has left to be accepted.
void leave_candidate(Store& store, const Robot& robot) {
  const std::int64_t id = must(store.begin(some_session(), some_plan(2, 6)));
  ResultRecord result = some_result(id);
  result.decision = ResultDecision::candidate;
  result.robot_text = robot_text(robot, values(robot));
  const SlotRecord candidate{id, id, model_hash(robot), result.robot_text};
  must(store.finish(result, &candidate));
}

TEST_F(Loop, GoesOnFromAPersonOnlyWhereTheWayHomeIsOpen) {
  const Config cell = config({{"motion.keep_out", "[{point: [-0.3, 0, 0], normal: [1, 0, 0]}]"}});
  leave_loaded_session(*opened(scratch.folder()), cell, robot.counts);
  start(cell);
  ASSERT_TRUE(comes_to(ServiceState::awaiting_person));
  const auto answer = [&] {
    person.replies.clear();
    person.say("done");
    turn_for(kSecond / 10);
    return person.replies.size() == 1 ? person.replies.front().why : "no answer";
  };

  robot.working = true;
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("does not stand still"));
  robot.working = false;
  robot.touching = true;
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("the trigger is closed"));
  robot.touching = false;
  robot.home[0] += 1.2;  // beyond that
  turn_for(kSecond);
  EXPECT_THAT(answer(), HasSubstr("no free way home"));
  EXPECT_EQ(state().state, ServiceState::awaiting_person);
  EXPECT_TRUE(robot.asked.empty());

  robot.home[0] -= 1.2;
  turn_for(kSecond);
  EXPECT_EQ(answer(), "done");
  EXPECT_EQ(robot.asked, std::vector{MoveKind::travel});
}

TEST_F(Loop, StopsTheRobotBeforeAnythingIsWritten) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  const std::unique_ptr<Store> beside = opened(scratch.folder());
  std::vector<std::string> held;
  robot.when_stopped = [&] { held.push_back(must(beside->remembered("held"))); };
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  ASSERT_FALSE(held.empty());
  EXPECT_EQ(held.front(), "") << "a disk may take seconds";
  EXPECT_EQ(must(beside->remembered("held")), "yes");
}

TEST_F(Loop, LeavesAloneWhatMovesByOthersOnceItsOwnMoveHasEnded) {
  const Config cell = config();
  leave_loaded_session(*opened(scratch.folder()), cell, robot.counts);
  robot.home[0] = 0.3;  // at the touch that was in progress
  robot.touching = robot.obeys = true;
  start(cell);
  ASSERT_TRUE(turning([&] { return !robot.asked.empty(); }));
  EXPECT_EQ(robot.asked, std::vector{MoveKind::retract});
  robot.touching = false;
  ASSERT_TRUE(comes_to(ServiceState::awaiting_person));
  robot.stops = 0;
  robot.working = true;  // by the hands of the person
  turn_for(kSecond);
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(kSecond);
  EXPECT_EQ(robot.stops, 0);
}

TEST_F(Loop, StopsNoContactOfOthersAfterAnAbort) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  turn_for(kSecond);
  robot.stops = 0;
  robot.touching = true;
  turn_for(kSecond);
  EXPECT_EQ(robot.stops, 0);
}

TEST_F(Loop, KeepsAResultWaitingThatTheStoreCouldNotAcceptOrReject) {
  const Config cell = config({{"commands.allow", "[accept, reject]"}});
  leave_candidate(*opened(scratch.folder()), *cell.robot);
  start(cell);
  for (const std::string verb : {"accept", "reject"}) {
    ASSERT_TRUE(comes_to(ServiceState::awaiting_acceptance));
    const std::string full = " ON slot BEGIN SELECT RAISE(FAIL, 'disk is full'); END;";
    change_store("CREATE TRIGGER a BEFORE UPDATE" + full + "CREATE TRIGGER b BEFORE DELETE" + full);
    person.replies.clear();
    person.say(verb);
    ASSERT_TRUE(comes_to(ServiceState::fault));
    ASSERT_EQ(person.replies.size(), 1) << verb;
    EXPECT_FALSE(person.replies.front().accepted) << verb;
    EXPECT_THAT(person.replies.front().why, HasSubstr("disk is full"));
    change_store("DROP TRIGGER a; DROP TRIGGER b");
  }
  ASSERT_TRUE(comes_to(ServiceState::awaiting_acceptance));
  person.say("accept");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_EQ(service->models().session(), 1);
}

TEST_F(Loop, MakesNoTouchOfASessionThatWasGivenUpAtItsBeginning) {
  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  person.say("start");
  ASSERT_TRUE(comes_to(ServiceState::planning));
  robot.working = true;
  ASSERT_TRUE(comes_to(ServiceState::fault));
  EXPECT_THAT(state().why, HasSubstr("does not stand still"));
  EXPECT_TRUE(state().unfinished);
  robot.working = false;
  person.say("abort");
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_EQ(must(store->session(1)).state, SessionState::aborted);

  start(config());
  ASSERT_TRUE(comes_to(ServiceState::idle));
  EXPECT_FALSE(state().unfinished);
  turn_for(kSecond);
  EXPECT_TRUE(robot.asked.empty());
}

TEST_F(Loop, BeginsNothingByItselfWhileTheRobotIsAtOtherWork) {
  start(config({{"schedule.every_hours", "0.001"}}));
  ASSERT_TRUE(comes_to(ServiceState::idle));
  robot.working = true;
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  const auto said_to_wait = [&] {
    const std::vector<EventRecord> events = must(store->events(20));
    return std::ranges::count_if(events, [](const EventRecord& event) {
      return event.text.find("waits until the robot has stood for 5 s") != std::string::npos;
    });
  };
  ASSERT_TRUE(turning([&] { return said_to_wait() == 1; }));
  turn_for(20 * kSecond);
  EXPECT_EQ(said_to_wait(), 1) << "once, and not every second";

  robot.working = false;
  turn_for(4 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle);
  ASSERT_TRUE(comes_to(ServiceState::planning));
  robot.working = true;
  ASSERT_TRUE(comes_to(ServiceState::idle)) << "once the touches are planned";
  EXPECT_FALSE(state().held);
  turn_for(20 * kSecond);
  EXPECT_EQ(state().state, ServiceState::idle) << state().why;
  EXPECT_TRUE(robot.asked.empty());

  robot.working = false;
  ASSERT_TRUE(comes_to(ServiceState::collecting));
  EXPECT_EQ(state().session, 1) << "the one that was planned";
}

}  // namespace
}  // namespace selfcal
