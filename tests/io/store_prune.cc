// Pruning: what goes first, what never goes, and how large ten years are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "tests/io/scratch.h"
#include "tests/io/store_records.h"

namespace selfcal {
namespace {

constexpr int kSessions = 12;
constexpr int kSteps = 240;

/// Thousands of commits, none of which need a disk: in memory where there is such a folder.
class StorePrune : public testing::Test {
 protected:
  StorePrune() {
    if (std::filesystem::is_directory("/dev/shm")) setenv("TEST_TMPDIR", "/dev/shm/", 1);
  }
  ~StorePrune() override { unsetenv("TEST_TMPDIR"); }
};

/// What is left of the store, counted.
struct Left {
  int events = 0, jsons = 0, postures = 0, raw = 0, outlier = 0, labels = 0;
};

Left left(Store& store) {
  Left left;
  left.events = static_cast<int>(store.events(1'000'000)->size());
  const auto sessions = store.sessions(1'000'000).value();
  for (const SessionRecord& session : sessions) {
    const auto result = store.result(session.id).value();
    left.jsons += result && !result->json.empty() ? 1 : 0;
    const auto plan = store.plan(session.id).value();
    left.labels += plan.empty() ? 0 : 1;
    left.postures += !plan.empty() && !plan[0].touch.empty() ? 1 : 0;
    bool taken = false;
    const auto touches = store.touches(session.id).value();
    for (const TouchRecord& touch : touches) {
      taken = taken || touch.outcome == TouchOutcome::taken;
      left.outlier += touch.outcome == TouchOutcome::outlier ? 1 : 0;
    }
    left.raw += taken ? 1 : 0;
  }
  return left;
}

/// Sessions of all kinds of content; the second is active.
std::unique_ptr<Store> store_of_sessions(const Scratch& scratch) {
  auto store = opened(scratch.folder());
  for (int i = 0; i < kSessions; ++i) {
    const std::int64_t id = store->begin(some_session(), some_plan(kSteps, 6)).value();
    for (int step = 0; step < kSteps; ++step) {
      TouchRecord touch = some_touch(step, 6);
      if (step == 5) touch.outcome = TouchOutcome::outlier;
      EXPECT_TRUE(store->add(id, touch).has_value());
    }
    ResultRecord result = some_result(id);
    result.json = std::string(9000, 'j');
    const SlotRecord candidate = candidate_of(result);
    EXPECT_TRUE(store->finish(result, i == 1 ? &candidate : nullptr).has_value());
    for (int k = 0; k < 20; ++k) {
      EXPECT_TRUE(store->add(EventRecord{0, k, "info", std::string(500, 'e')}).has_value());
    }
  }
  EXPECT_TRUE(store->accept(1).has_value());
  return store;
}

// Each later kind is only touched once nothing of the earlier ones may still go.
TEST_F(StorePrune, ForgetsEventsThenJsonThenPlansThenRawRowsOldestFirst) {
  const Scratch scratch;
  const auto store = store_of_sessions(scratch);
  Left before = left(*store);
  for (std::int64_t most = store->bytes().value(); most > 0; most -= 20'000) {
    ASSERT_TRUE(store->prune(most).has_value());
    const Left now = left(*store);
    if (now.jsons < kSessions) {
      EXPECT_EQ(now.events, 0);
    }
    if (now.postures < kSessions) {
      EXPECT_EQ(now.jsons, 2);
    }
    EXPECT_EQ(now.outlier, now.postures);
    if (now.raw < kSessions) {
      EXPECT_EQ(now.postures, 2);
    }
    EXPECT_EQ(now.labels, now.raw);
    if (now.raw > 2) {
      EXPECT_LE(store->bytes().value(), most);
    }
    EXPECT_LE(now.events + now.jsons + now.raw, before.events + before.jsons + before.raw);
    before = now;
  }
  EXPECT_EQ(before.raw, 2);
}

TEST_F(StorePrune, NeverForgetsTheNewestTheResumableTheActiveOrAnyFigure) {
  const Scratch scratch;
  auto store = store_of_sessions(scratch);
  const std::int64_t resumable = store->begin(some_session(), some_plan(10, 6)).value();
  ASSERT_TRUE(store->add(resumable, some_touch(0, 6)).has_value());
  const std::int64_t newest = whole_session(*store, 10);
  ASSERT_TRUE(store->set_state(resumable, SessionState::collected, 0).has_value());
  ASSERT_TRUE(store->prune(0).has_value());
  store = opened(scratch.folder());

  for (const std::int64_t id : {std::int64_t{2}, resumable, newest}) {
    EXPECT_FALSE(store->touches(id)->empty());
    EXPECT_FALSE(store->plan(id)->front().touch.empty());
  }
  EXPECT_TRUE(store->touches(3)->empty());
  EXPECT_FALSE(store->result(2).value()->json.empty());
  EXPECT_EQ(store->results(100)->size(), static_cast<std::size_t>(kSessions + 1));
  EXPECT_EQ(store->result(3).value()->robot_text, some_result(3).robot_text);
  EXPECT_EQ(store->session(1)->config, some_session().config);
}

TEST_F(StorePrune, KeepsTheNamesOfStepsAsLongAsTheirRawRows) {
  const Scratch scratch;
  const auto store = store_of_sessions(scratch);
  std::int64_t most = store->bytes().value();
  while (!store->plan(1)->front().touch.empty()) {
    ASSERT_TRUE(store->prune(most -= 10'000).has_value());
  }
  const auto plan = store->plan(1).value();
  ASSERT_EQ(plan.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(plan[9].set, some_plan(kSteps, 6)[9].set);
  EXPECT_TRUE(plan[9].start.empty());
  EXPECT_EQ(store->touches(1)->size(), static_cast<std::size_t>(kSteps - 1));
}

TEST_F(StorePrune, LeavesAloneWhatFitsAndShrinksTheFileOtherwise) {
  const Scratch scratch;
  const auto store = store_of_sessions(scratch);
  const auto path = scratch.folder() / "selfcal.db";
  const std::int64_t all = store->bytes().value();
  ASSERT_TRUE(store->prune(all).has_value());
  EXPECT_EQ(store->bytes().value(), all);
  EXPECT_EQ(left(*store).jsons, kSessions);
  ASSERT_TRUE(store->prune(all / 2).has_value());
  EXPECT_LE(std::filesystem::file_size(path), static_cast<std::size_t>(all / 2));
  EXPECT_EQ(std::filesystem::file_size(scratch.folder() / "selfcal.db-wal"), 0u);
}

// Ten years of a session a night must stay near 100 MB with every raw row. The measured part of
// 50 sessions stands for 3650; postures of plans, which the planner can make again, may go.
TEST_F(StorePrune, TenYearsOfNightlySessionsFitIn110MegabytesWithEveryRawRow) {
  constexpr int kNights = 50;
  constexpr std::int64_t kShare = std::int64_t{110'000'000} * kNights / 3650;
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const auto start = std::chrono::steady_clock::now();
  for (int night = 0; night < kNights; ++night) {
    const std::int64_t id = store->begin(some_session(), some_plan(kSteps, 6)).value();
    for (int i = 0; i < kSteps; ++i) ASSERT_TRUE(store->add(id, some_touch(i, 6)).has_value());
    ResultRecord result = some_result(id);
    result.json = std::string(20'000, 'j');
    result.robot_text += std::string(1'900, 'r');
    ASSERT_TRUE(store->finish(result, nullptr).has_value());
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  RecordProperty("bytes_a_session_unpruned", std::to_string(store->bytes().value() / kNights));
  RecordProperty("ms_a_commit", std::to_string(took.count() / (kNights * (kSteps + 2))));

  ASSERT_TRUE(store->prune(kShare).has_value());

  EXPECT_LE(store->bytes().value(), kShare);
  for (std::int64_t id = 1; id <= kNights; ++id) {
    ASSERT_EQ(store->touches(id)->size(), static_cast<std::size_t>(kSteps));
    EXPECT_EQ(store->plan(id)->size(), static_cast<std::size_t>(kSteps));
  }
}

}  // namespace
}  // namespace selfcal
