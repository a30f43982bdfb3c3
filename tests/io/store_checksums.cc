// What other hands change in the store is never returned as what it says: it is named, set aside,
// and the last good parameters are used.
#include "io/store/checksums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/file.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

class StoreChecksums : public testing::Test {
 protected:
  StoreChecksums() { fill(*opened(scratch_.folder())); }

  void change(const std::string& sql) { with_sqlite(scratch_.folder() / "selfcal.db", sql); }

  /// Opens the store again, which then says so.
  void open() {
    Result<Store::Opened> again = Store::open(scratch_.folder());
    ASSERT_TRUE(again.has_value()) << again.error().what;
    said_ = again->set_aside;
    store_ = std::move(again->store);
  }

  std::int64_t session_in(Slot slot) const {
    const auto record = store_->slot(slot).value();
    return record ? record->session : -1;
  }

  const Scratch scratch_;
  std::unique_ptr<Store> store_;
  std::string said_;
};

TEST_F(StoreChecksums, SayNothingOfASoundStore) {
  open();
  EXPECT_EQ(said_, "");
  EXPECT_TRUE(store_->damage()->empty());
  content_of(*store_);
  EXPECT_TRUE(store_->met().empty());
}

TEST_F(StoreChecksums, ADigitOfTheActiveRobotIsSeenAndThePreviousParametersAreActive) {
  change("UPDATE text SET body = replace(body, '0.499', '0.899') WHERE body LIKE '%0.499%'");

  open();

  EXPECT_THAT(said_, AllOf(HasSubstr("selfcal.db: damaged and not used"),
                           HasSubstr("the active parameters (session 2)")));
  const SlotRecord active = store_->slot(Slot::active).value().value();
  EXPECT_EQ(active.session, 1);
  EXPECT_THAT(active.robot_text, HasSubstr("0.501"));
  EXPECT_EQ(session_in(Slot::previous), -1);
  EXPECT_EQ(store_->result(2).value()->robot_text, "");
  EXPECT_EQ(content_of(*store_).find("0.899"), std::string::npos);
  const DamageRecord note = store_->damage()->back();
  EXPECT_EQ(note.place, "active");
  EXPECT_EQ(note.what, "the active parameters (session 2)");
  EXPECT_THAT(note.row, HasSubstr("0, 2, "));  // slot and session, for a person
  EXPECT_GE(active.since_ms, note.unix_ms);
}

TEST_F(StoreChecksums, ADigitWithANewHashIsSeenToo) {
  const std::string body = "robot: arm\nframes:\n  - {name: base, joint: fixed, r: 0.899}\n";
  change("UPDATE text SET body = '" + body + "', hash = '" + sha256_hex(body) +
         "' WHERE body LIKE '%0.499%'");
  open();
  EXPECT_THAT(said_, HasSubstr("the active parameters (session 2)"));
  EXPECT_EQ(session_in(Slot::active), 1);
}

TEST_F(StoreChecksums, ASlotThatPointsToAnotherTextIsSeen) {
  change("UPDATE slot SET robot = (SELECT robot FROM slot WHERE slot = 2) WHERE slot = 0");
  open();
  EXPECT_THAT(said_, HasSubstr("the active parameters (session 2)"));
  EXPECT_EQ(session_in(Slot::active), 1);
  EXPECT_EQ(session_in(Slot::candidate), 3);
}

TEST_F(StoreChecksums, SlotsThatChangedPlacesAreSeen) {
  change(
      "UPDATE slot SET slot = 9 WHERE slot = 0; UPDATE slot SET slot = 0 WHERE slot = 2;"
      "UPDATE slot SET slot = 2 WHERE slot = 9;");
  open();
  EXPECT_EQ(session_in(Slot::active), 1);
  EXPECT_EQ(session_in(Slot::candidate), -1);
}

TEST_F(StoreChecksums, PreviousParametersWhoseKeyChangedAreNotActive) {
  change("DELETE FROM slot WHERE slot = 0; UPDATE slot SET slot = 0 WHERE slot = 1");
  open();
  EXPECT_EQ(session_in(Slot::active), -1);
  EXPECT_EQ(session_in(Slot::previous), -1);
  EXPECT_NE(said_, "");
}

TEST_F(StoreChecksums, WithoutAGoodPreviousSlotTheFactorysAreUsed) {
  change("UPDATE slot SET since_ms = since_ms + 1 WHERE slot < 2");
  open();
  EXPECT_THAT(said_, AllOf(HasSubstr("the active parameters (session 2)"),
                           HasSubstr("the previous parameters (session 1)")));
  EXPECT_EQ(session_in(Slot::active), -1);
  EXPECT_EQ(session_in(Slot::previous), -1);
}

TEST_F(StoreChecksums, ADamagedCandidateIsDroppedWithTheReason) {
  change("UPDATE text SET body = replace(body, '0.498', '0.408') WHERE body LIKE '%0.498%'");
  open();
  EXPECT_THAT(said_, HasSubstr("the candidate (session 3)"));
  EXPECT_EQ(session_in(Slot::candidate), -1);
  EXPECT_THAT(store_->accept(9).error().what, HasSubstr("no candidate to accept"));
  const ResultRecord result = store_->result(3).value().value();
  EXPECT_EQ(result.decision, ResultDecision::rejected);
  EXPECT_THAT(result.why, HasSubstr("damaged in the store"));
  EXPECT_EQ(session_in(Slot::active), 2);
}

// While the service runs, nobody looks before it is asked for.
TEST_F(StoreChecksums, ACandidateDamagedSinceIsNotAccepted) {
  open();
  change("UPDATE text SET body = replace(body, '0.498', '0.408') WHERE body LIKE '%0.498%'");
  EXPECT_THAT(store_->accept(9).error().what, HasSubstr("the candidate (session 3): damaged"));
  EXPECT_EQ(session_in(Slot::active), 2);
  EXPECT_FALSE(store_->slot(Slot::candidate).has_value());
  EXPECT_THAT(store_->met(), Contains("the candidate (session 3)"));
  EXPECT_TRUE(store_->reject(10).has_value());
  EXPECT_EQ(session_in(Slot::candidate), -1);
}

TEST_F(StoreChecksums, ActiveParametersDamagedSinceNeverBecomeThePrevious) {
  open();
  change("UPDATE slot SET model_hash = 'another' WHERE slot = 0");
  ASSERT_TRUE(store_->accept(9).has_value());
  EXPECT_EQ(session_in(Slot::active), 3);
  EXPECT_EQ(session_in(Slot::previous), 1);
  EXPECT_EQ(store_->damage()->front().place, "active");
}

TEST_F(StoreChecksums, FromActiveParametersDamagedSinceAWayBackIsThere) {
  open();
  ASSERT_TRUE(store_->reject(8).has_value());
  change("UPDATE slot SET model_hash = 'another' WHERE slot = 0");
  ASSERT_TRUE(store_->roll_back(9).has_value());
  EXPECT_EQ(session_in(Slot::active), 1);
  EXPECT_EQ(session_in(Slot::previous), -1);
}

TEST_F(StoreChecksums, ToDamagedPreviousParametersThereIsNoWayBack) {
  open();
  ASSERT_TRUE(store_->reject(8).has_value());
  change("UPDATE slot SET model_hash = 'another' WHERE slot = 1");
  EXPECT_THAT(store_->roll_back(9).error().what, HasSubstr("the previous parameters (session 1)"));
  EXPECT_EQ(session_in(Slot::active), 2);
}

TEST_F(StoreChecksums, ADamagedTouchIsNoRowAndTheSessionGoesOn) {
  change("UPDATE touch SET step = 2 WHERE id = (4 << 20) + 1");
  open();
  EXPECT_THAT(said_, HasSubstr("touch 1 of session 4"));
  EXPECT_EQ(store_->unfinished().value()->id, 4);
  const auto touches = store_->touches(4).value();
  ASSERT_EQ(touches.size(), 2u);
  expect_same(touches[0], some_touch(0, 6));
  expect_same(touches[1], some_touch(2, 6));
}

TEST_F(StoreChecksums, ADamagedPlanEndsTheSessionAndKeepsWhatWasCollected) {
  for (const char* sql : {"UPDATE plan SET labels = x'00' WHERE session = 4",
                          "UPDATE posture SET postures = x'00' WHERE session = 4"}) {
    const Scratch scratch;
    fill(*opened(scratch.folder()));
    with_sqlite(scratch.folder() / "selfcal.db", sql);
    const auto again = Store::open(scratch.folder()).value();
    EXPECT_THAT(again.set_aside, HasSubstr("session 4 cannot go on and is ended"));
    EXPECT_FALSE(again.store->unfinished().value().has_value());
    EXPECT_EQ(again.store->session(4)->state, SessionState::aborted);
    EXPECT_EQ(again.store->touches(4)->size(), 3u);
  }
}

TEST_F(StoreChecksums, OfAPlanThatIsDoneDamagedPosturesAreAsPrunedOnes) {
  change("UPDATE posture SET postures = x'00' WHERE session = 2");
  open();
  const auto plan = store_->plan(2).value();
  ASSERT_EQ(plan.size(), 6u);
  EXPECT_EQ(plan[3].set, some_plan(6, 6)[3].set);
  EXPECT_TRUE(plan[3].start.empty());
}

TEST_F(StoreChecksums, ADamagedResultIsLeftOutAndTheOthersStand) {
  change("UPDATE result SET check_after = 1e-9 WHERE session = 3");
  open();
  EXPECT_THAT(said_, HasSubstr("the result of session 3"));
  EXPECT_THAT(store_->result(3).error().what, HasSubstr("the result of session 3 is damaged"));
  const auto results = store_->results(1).value();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].session, 2);
}

TEST_F(StoreChecksums, ListsSayWhichRowIsDamaged) {
  change(
      "UPDATE session SET kind = 'check' WHERE id = 2; UPDATE event SET level = 'debug' WHERE id = "
      "7");
  open();
  const auto sessions = store_->sessions(10).value();
  ASSERT_EQ(sessions.size(), 4u);
  EXPECT_EQ(sessions[2].id, 2);
  EXPECT_EQ(sessions[2].kind, "");
  EXPECT_THAT(sessions[2].reason, HasSubstr("damaged"));
  EXPECT_THAT(store_->session(2).error().what, HasSubstr("session 2 is damaged"));
  const auto events = store_->events(100).value();
  ASSERT_EQ(events.size(), 12u);
  EXPECT_EQ(events[5].id, 7);
  EXPECT_EQ(events[5].level, "error");
  EXPECT_THAT(events[5].text, HasSubstr("damaged"));
}

TEST_F(StoreChecksums, WhatWasRememberedIsNotGuessed) {
  change("UPDATE remembered SET text = '' WHERE name = 'held'");
  open();
  EXPECT_THAT(store_->remembered("held").error().what, HasSubstr("damaged"));
  ASSERT_TRUE(store_->remember("held", "yes").has_value());
  EXPECT_EQ(store_->remembered("held").value(), "yes");
}

TEST_F(StoreChecksums, ATextIsWholeAgainOnceItIsKeptAgain) {
  change("UPDATE text SET body = 'joints: [b, a]' WHERE id = (SELECT config FROM session LIMIT 1)");
  open();
  EXPECT_THAT(said_, HasSubstr("the configuration of session 1"));
  EXPECT_THAT(store_->session(1).error().what,
              HasSubstr("the configuration of session 1 is damaged"));
  EXPECT_EQ(store_->sessions(10)->back().config, "");
  ASSERT_TRUE(store_->begin(some_session(), some_plan(2, 6)).has_value());
  EXPECT_EQ(store_->session(1)->config, some_session().config);
}

TEST_F(StoreChecksums, WhatWasFoundStaysNotedAndIsNotFoundAgain) {
  change("UPDATE touch SET outcome = 1 WHERE id = (2 << 20) + 1");
  open();
  EXPECT_THAT(said_, HasSubstr("touch 1 of session 2"));
  store_.reset();
  open();
  EXPECT_EQ(said_, "");
  ASSERT_EQ(store_->damage()->size(), 1u);
  EXPECT_EQ(store_->damage()->front().what, "touch 1 of session 2");
  EXPECT_EQ(store_->touches(2)->size(), 5u);
  EXPECT_TRUE(store_->met().empty());
}

TEST_F(StoreChecksums, AReaderNamesWhatIsDamagedAndWritesNothing) {
  change("UPDATE slot SET since_ms = 7 WHERE slot = 0");
  const auto reader = Store::open_to_read(scratch_.folder()).value();
  EXPECT_THAT(reader->met(), Contains("the active parameters (session 2)"));
  EXPECT_FALSE(reader->slot(Slot::active).has_value());
  EXPECT_TRUE(reader->damage()->empty());
}

/// The columns of a table.
std::vector<std::string> columns(const std::filesystem::path& path, const std::string& table) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  sqlite3_stmt* rows = nullptr;
  const std::string sql = "SELECT name FROM pragma_table_info('" + table + "')";
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &rows, nullptr), SQLITE_OK);
  std::vector<std::string> names;
  while (sqlite3_step(rows) == SQLITE_ROW) {
    names.emplace_back(reinterpret_cast<const char*>(sqlite3_column_text(rows, 0)));
  }
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return names;
}

// A checksum that leaves out a column shows here, as does a table without one.
TEST_F(StoreChecksums, CoverEveryColumnOfEveryTable) {
  const auto path = scratch_.folder() / "selfcal.db";
  change("UPDATE event SET level = 'debug' WHERE id = 1");
  open();  // so that there is a note of damage, too
  ASSERT_TRUE(store_->prune(1 << 30).has_value());
  store_.reset();
  const std::string sound = read_file(path, 1 << 30).value();
  int changed = 0;
  for (const Verified& table : kVerified) {
    for (const std::string& column : columns(path, table.table)) {
      std::filesystem::remove(path.string() + "-wal");
      scratch_.write("selfcal.db", sound);
      const std::string value = "CASE typeof(" + column + ") WHEN 'text' THEN " + column +
                                " || 'x' WHEN 'blob' THEN x'00' WHEN 'null' THEN 7 ELSE " + column +
                                " + 1000 END";
      change("UPDATE " + std::string(table.table) + " SET " + column + " = iif('" + column +
             "' IN ('why', 'row') AND " + column + " IS NULL, 'x', " + value + ") WHERE " +
             table.key + " = (SELECT max(" + table.key + ") FROM " + table.table + ")");
      open();
      EXPECT_NE(said_, "") << table.table << '.' << column;
      store_.reset();
      ++changed;
    }
  }
  std::printf("%d columns, each changed in one row\n", changed);
  EXPECT_GE(changed, 60);
}

TEST(StoreSalvage, BrokenPagesCostTheirRowsAndNotTheParameters) {
  const Scratch scratch;
  {
    const auto store = opened(scratch.folder());
    fill(*store);
    for (int i = 0; i < 4; ++i) whole_session(*store, 240);
    ASSERT_TRUE(store->prune(1 << 30).has_value());
  }
  std::string bytes = read_file(scratch.folder() / "selfcal.db", 1 << 30).value();
  // The middle of the file: touches and postures.
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 3000; ++i) bytes[i] = '\x5a';
  scratch.write("selfcal.db", bytes);

  const auto again = Store::open(scratch.folder()).value();

  EXPECT_THAT(again.set_aside, AllOf(HasSubstr("was damaged and is now selfcal.db.damaged-1"),
                                     HasSubstr("rows that could be read")));
  EXPECT_EQ(again.store->slot(Slot::active).value()->robot_text, kRobotText);
  EXPECT_EQ(again.store->slot(Slot::previous).value()->session, 1);
  EXPECT_EQ(again.store->sessions(100)->size(), 8u);
  EXPECT_EQ(again.store->results(100)->size(), 7u);
  EXPECT_EQ(again.store->damage()->front().place, "store");
}

}  // namespace
}  // namespace selfcal
