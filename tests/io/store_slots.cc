// Accepting, rejecting and going back, and what they say in the results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/scratch.h"
#include "tests/io/store_records.h"

namespace selfcal {
namespace {

/// Sessions behind active, previous and candidate; -1 for an empty slot.
std::vector<std::int64_t> behind(Store& store) {
  std::vector<std::int64_t> sessions;
  for (const Slot slot : {Slot::active, Slot::previous, Slot::candidate}) {
    const std::optional<SlotRecord> record = store.slot(slot).value();
    sessions.push_back(record ? record->session : -1);
  }
  return sessions;
}

ResultDecision decision(Store& store, std::int64_t session) {
  return store.result(session).value()->decision;
}

using Sessions = std::vector<std::int64_t>;

TEST(StoreSlots, AreEmptyAtFirstAndThenNothingCanBeDone) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, -1}));
  EXPECT_THAT(store->accept(1).error().what, testing::HasSubstr("no candidate to accept"));
  EXPECT_THAT(store->reject(1).error().what, testing::HasSubstr("no candidate to reject"));
  EXPECT_THAT(store->roll_back(1).error().what, testing::HasSubstr("nothing further back"));
}

TEST(StoreSlots, GiveBackACandidateBitByBit) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = whole_session(*store, 2, true);
  const SlotRecord expected = candidate_of(some_result(id));
  const SlotRecord back = store->slot(Slot::candidate).value().value();
  EXPECT_EQ(back.session, id);
  EXPECT_EQ(back.since_ms, expected.since_ms);
  EXPECT_EQ(back.model_hash, expected.model_hash);
  EXPECT_EQ(back.robot_text, expected.robot_text);
}

TEST(StoreSlots, AcceptMovesActiveToPreviousAndSaysApplied) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t a = whole_session(*store, 2, true);
  ASSERT_TRUE(store->accept(10).has_value());
  EXPECT_EQ(behind(*store), (Sessions{a, -1, -1}));
  const std::int64_t b = whole_session(*store, 2, true);
  EXPECT_EQ(behind(*store), (Sessions{a, -1, b}));
  EXPECT_EQ(decision(*store, b), ResultDecision::candidate);
  ASSERT_TRUE(store->accept(20).has_value());
  EXPECT_EQ(behind(*store), (Sessions{b, a, -1}));
  EXPECT_EQ(decision(*store, b), ResultDecision::applied);
  EXPECT_EQ(store->slot(Slot::active).value()->since_ms, 20);
  EXPECT_FALSE(store->accept(30).has_value());
}

TEST(StoreSlots, RejectDropsTheCandidateAndSaysRejected) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t a = whole_session(*store, 2, true);
  ASSERT_TRUE(store->reject(10).has_value());
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, -1}));
  EXPECT_EQ(decision(*store, a), ResultDecision::rejected);
}

TEST(StoreSlots, ANewCandidateReplacesTheOldOneAndSaysSo) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t a = whole_session(*store, 2, true);
  const std::int64_t b = whole_session(*store, 2, true);
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, b}));
  EXPECT_EQ(decision(*store, a), ResultDecision::replaced);
  EXPECT_EQ(decision(*store, b), ResultDecision::candidate);
}

TEST(StoreSlots, RollBackGoesStepByStepAndNeverForth) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t a = whole_session(*store, 2, true);
  ASSERT_TRUE(store->accept(10).has_value());
  const std::int64_t b = whole_session(*store, 2, true);
  ASSERT_TRUE(store->accept(20).has_value());
  ASSERT_TRUE(store->roll_back(30).has_value());
  EXPECT_EQ(behind(*store), (Sessions{a, -1, -1}));
  EXPECT_EQ(store->slot(Slot::active).value()->since_ms, 30);
  EXPECT_EQ(decision(*store, b), ResultDecision::rolled_back);
  ASSERT_TRUE(store->roll_back(40).has_value());
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, -1}));
  EXPECT_THAT(store->roll_back(50).error().what, testing::HasSubstr("nothing further back"));
}

TEST(StoreSlots, RollBackFromTheFirstParametersGoesToTheFactorys) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  whole_session(*store, 2, true);
  ASSERT_TRUE(store->accept(10).has_value());
  ASSERT_TRUE(store->roll_back(20).has_value());
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, -1}));
  const std::int64_t b = whole_session(*store, 2, true);
  ASSERT_TRUE(store->accept(30).has_value());
  EXPECT_EQ(behind(*store), (Sessions{b, -1, -1}));  // before b were the factory's, not a
}

TEST(StoreSlots, KeepTheFactorysRobotUnderNoSession) {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  const std::int64_t id = store->begin(some_session(), some_plan(2, 6)).value();
  const SlotRecord factory{0, 5, "hash", "robot"};
  ASSERT_TRUE(store->finish(some_result(id), &factory).has_value());
  EXPECT_EQ(behind(*store), (Sessions{-1, -1, 0}));
  ASSERT_TRUE(store->accept(6).has_value());
  EXPECT_EQ(decision(*store, id), ResultDecision::candidate);
}

}  // namespace
}  // namespace selfcal
