// The store gives back what it was given, bit by bit, and refuses what cannot be.
#include "io/store/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/scratch.h"
#include "tests/io/store_records.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

template <class T>
void expect_failure(const Result<T>& result, const std::string& what,
                    int exit_status = kDeviceFailed) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().exit_status, exit_status);
  EXPECT_THAT(result.error().what, HasSubstr("selfcal.db: "));
  EXPECT_THAT(result.error().what, HasSubstr(what));
}

TEST(Store, GivesBackASession) {
  const Scratch scratch;
  SessionRecord session = some_session();
  session.id = opened(scratch.folder())->begin(session, some_plan(5, 6)).value();
  const auto store = opened(scratch.folder());

  const SessionRecord back = store->session(session.id).value();

  EXPECT_EQ(back.id, session.id);
  EXPECT_EQ(back.kind, session.kind);
  EXPECT_EQ(back.reason, session.reason);
  EXPECT_EQ(back.model_hash, session.model_hash);
  EXPECT_EQ(back.config_hash, session.config_hash);
  EXPECT_EQ(back.config, session.config);
  EXPECT_EQ(back.seed, session.seed);
  EXPECT_EQ(back.state, SessionState::collecting);
  EXPECT_EQ(back.started_ms, session.started_ms);
  EXPECT_EQ(back.ended_ms, 0);
  EXPECT_EQ(back.steps, 5);
}

TEST(Store, ExtendsThePlanOfASessionThatGoesOn) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(3, 6)).value();
  ASSERT_TRUE(store->set_state(id, SessionState::collected, 5));

  ASSERT_TRUE(store->extend(id, some_plan(2, 6, 9)));

  const auto back = opened(scratch.folder())->plan(id).value();
  ASSERT_EQ(back.size(), 5);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(back[static_cast<std::size_t>(i)].index, i);
  EXPECT_EQ(back[2].start, some_plan(3, 6)[2].start);
  EXPECT_EQ(back[4].end, some_plan(2, 6, 9)[1].end);
  const SessionRecord session = store->session(id).value();
  EXPECT_EQ(session.steps, 5);
  EXPECT_EQ(session.state, SessionState::collecting);
}

TEST(Store, ExtendsNoSessionThatHasEnded) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(3, 6)).value();
  ASSERT_TRUE(store->set_state(id, SessionState::aborted, 5));
  expect_failure(store->extend(id, some_plan(2, 6)), "session 1 has ended");
  EXPECT_EQ(store->plan(id).value().size(), 3);
}

TEST(Store, GivesBackAPlanBitByBit) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  std::vector<StepRecord> plan = some_plan(50, 7);
  plan[3].start = {-0.0, std::numeric_limits<double>::infinity(), 5e-324};
  plan[4].touch.clear();
  plan[5].set = "";
  plan[6].group = std::string("with\0 zero, µ and\n", 19);
  plan[7].index = -3;
  plan[8].slow = plan[9].loaded = plan[10].slow = plan[10].loaded = true;
  const std::int64_t id = store->begin(some_session(), plan).value();

  const std::vector<StepRecord> back = store->plan(id).value();

  ASSERT_EQ(back.size(), plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(back[i].index, plan[i].index);
    EXPECT_EQ(back[i].set, plan[i].set);
    EXPECT_EQ(back[i].group, plan[i].group);
    EXPECT_EQ(back[i].check, plan[i].check);
    EXPECT_EQ(back[i].via_home, plan[i].via_home);
    EXPECT_EQ(back[i].slow, plan[i].slow);
    EXPECT_EQ(back[i].loaded, plan[i].loaded);
    EXPECT_EQ(back[i].way, plan[i].way);
    EXPECT_EQ(back[i].start, plan[i].start);
    EXPECT_EQ(back[i].touch, plan[i].touch);
    EXPECT_EQ(back[i].end, plan[i].end);
  }
  EXPECT_TRUE(std::signbit(back[3].start[0]));
}

TEST(Store, GivesBackTouchesBitByBitInTheOrderTheyCame) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(16, kMostJoints)).value();
  std::vector<TouchRecord> touches;
  for (const int step : {3, 1, 2, 0}) touches.push_back(some_touch(step, kMostJoints));
  touches[1].outcome = TouchOutcome::outlier;
  touches[1].why = "no edge within 2 s";
  touches[1].attempt = 300;
  touches[1].temperature = std::numeric_limits<double>::quiet_NaN();
  touches[2].temperature = -0.0;
  touches[2].before.counts[0] = std::numeric_limits<std::int64_t>::min();
  touches[2].after.counts[0] = std::numeric_limits<std::int64_t>::max();
  touches[2].edge = std::numeric_limits<std::int64_t>::min();
  touches[3].before = touches[3].after = EncoderSample{};
  for (const TouchRecord& touch : touches) ASSERT_TRUE(store->add(id, touch).has_value());

  const std::vector<TouchRecord> back = store->touches(id).value();

  ASSERT_EQ(back.size(), touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) expect_same(back[i], touches[i]);
}

TEST(Store, GivesBackAResultBitByBitAndEndsTheSession) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(5, 6)).value();
  EXPECT_FALSE(store->result(id).value().has_value());
  ResultRecord result = some_result(id);
  result.p_value = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(store->finish(result, nullptr).has_value());

  const ResultRecord back = store->result(id).value().value();

  EXPECT_EQ(back.session, id);
  EXPECT_EQ(back.unix_ms, result.unix_ms);
  EXPECT_EQ(back.answer, result.answer);
  EXPECT_EQ(back.decision, result.decision);
  EXPECT_EQ(back.why, result.why);
  EXPECT_TRUE(std::isnan(back.p_value));
  EXPECT_TRUE(same_bits(back.check_before, result.check_before));
  EXPECT_TRUE(same_bits(back.check_after, result.check_after));
  EXPECT_TRUE(same_bits(back.endpoint_sigma, result.endpoint_sigma));
  EXPECT_EQ(back.touches, result.touches);
  EXPECT_EQ(back.outliers, result.outliers);
  EXPECT_EQ(back.identified, result.identified);
  EXPECT_EQ(back.json, result.json);
  EXPECT_EQ(back.robot_text, result.robot_text);
  EXPECT_EQ(store->session(id)->state, SessionState::finished);
  EXPECT_EQ(store->session(id)->ended_ms, result.unix_ms);
}

TEST(Store, ListsTheNewestFirstAndNoMoreThanAsked) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  for (int i = 0; i < 4; ++i) whole_session(*store, 2);
  const auto sessions = store->sessions(3).value();
  const auto results = store->results(2).value();
  ASSERT_EQ(sessions.size(), 3u);
  EXPECT_GT(sessions[0].id, sessions[1].id);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].session, sessions[0].id);
  EXPECT_EQ(results[0].json, "");
  EXPECT_TRUE(store->sessions(-1)->empty());
}

TEST(Store, ResumesTheSessionThatHasNotEnded) {
  const Scratch scratch;
  auto store = opened(scratch.folder());
  EXPECT_FALSE(store->unfinished().value().has_value());
  const std::int64_t first = store->begin(some_session(), some_plan(3, 6)).value();
  EXPECT_EQ(store->unfinished().value()->id, first);
  SessionRecord later = some_session();
  later.started_ms = 5;
  const std::int64_t second = store->begin(later, some_plan(3, 6)).value();
  EXPECT_EQ(store->session(first)->state, SessionState::aborted) << "it has been given up";
  EXPECT_EQ(store->session(first)->ended_ms, 5);
  ASSERT_TRUE(store->add(second, some_touch(0, 6)).has_value());
  store = opened(scratch.folder());

  EXPECT_EQ(store->unfinished().value()->id, second);
  EXPECT_EQ(store->touches(second)->size(), 1u);
  ASSERT_TRUE(store->set_state(second, SessionState::collected, 7).has_value());
  EXPECT_EQ(store->unfinished().value()->state, SessionState::collected);
  EXPECT_EQ(store->session(second)->ended_ms, 0);
  ASSERT_TRUE(store->set_state(second, SessionState::aborted, 8).has_value());
  EXPECT_EQ(store->session(second)->ended_ms, 8);
  EXPECT_FALSE(store->unfinished().value().has_value());
}

TEST(Store, RefusesASessionThatIsNotThereAndSaysWhichAre) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const auto expect_refused = [](const auto& result, const std::string& there) {
    expect_failure(result, "there is no session 7: " + there, kBadInput);
  };
  expect_refused(store->session(7), "it has none yet");
  ASSERT_TRUE(store->begin(some_session(), some_plan(3, 6)));
  expect_refused(store->session(7), "it has session 1");
  expect_refused(store->plan(7), "it has session 1");
  expect_refused(store->touches(7), "it has session 1");
  expect_refused(store->result(7), "it has session 1");
  expect_refused(store->set_state(7, SessionState::aborted, 1), "it has session 1");
  expect_refused(store->add(7, some_touch(0, 6)), "it has session 1");
  expect_refused(store->finish(some_result(7), nullptr), "it has session 1");
}

TEST(Store, RefusesATouchOfNoStepOrOfASessionThatEnded) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(3, 6)).value();
  expect_failure(store->add(id, some_touch(3, 6)), "no step 3");
  expect_failure(store->add(id, some_touch(-1, 6)), "no step -1");
  ASSERT_TRUE(store->set_state(id, SessionState::aborted, 1).has_value());
  expect_failure(store->add(id, some_touch(0, 6)), "has ended");
  EXPECT_TRUE(store->touches(id)->empty());
}

TEST(Store, RefusesASecondResultAndKeepsTheCandidateOfTheFirst) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = whole_session(*store, 2, true);
  SlotRecord other = candidate_of(some_result(id));
  other.robot_text = "another";
  EXPECT_FALSE(store->finish(some_result(id), &other).has_value());
  EXPECT_EQ(store->slot(Slot::candidate).value()->robot_text, some_result(id).robot_text);
}

TEST(Store, RemembersWhatIsToFollowWithTheResultOrNotAtAll) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(2, 6)).value();
  ASSERT_TRUE(store->finish(some_result(id), nullptr, {"wanted", "full"}));
  EXPECT_EQ(store->remembered("wanted").value(), "full");
  EXPECT_FALSE(store->finish(some_result(id), nullptr, {"wanted", "cause"}));
  EXPECT_EQ(store->remembered("wanted").value(), "full");
}

TEST(Store, RefusesTextsBeyondItsBound) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  SessionRecord session = some_session();
  session.config = std::string((std::size_t{16} << 20) + 1, 'x');
  expect_failure(store->begin(session, {}), "too big");
  EXPECT_TRUE(store->sessions(1)->empty());
}

TEST(Store, KeepsEventsAndSmallTexts) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  ASSERT_TRUE(store->add(EventRecord{9, 100, "info", "started"}).has_value());
  ASSERT_TRUE(store->add(EventRecord{9, 200, "error", "the trigger is silent"}).has_value());
  const auto events = store->events(10).value();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].unix_ms, 200);
  EXPECT_EQ(events[0].level, "error");
  EXPECT_EQ(events[0].text, "the trigger is silent");
  EXPECT_GT(events[0].id, events[1].id);

  EXPECT_EQ(store->remembered("motion_hours").value(), "");
  ASSERT_TRUE(store->remember("motion_hours", "1.5").has_value());
  ASSERT_TRUE(store->remember("motion_hours", "1.75").has_value());
  EXPECT_EQ(store->remembered("motion_hours").value(), "1.75");
}

}  // namespace
}  // namespace selfcal
