// A store of the first version, which had no checksums: it is read as before, and from then on
// verified.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/store/packing.h"
#include "io/store/schema.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string hex(const std::string& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "x'";
  for (const char each : bytes) {
    text += kDigits[static_cast<unsigned char>(each) >> 4];
    text += kDigits[static_cast<unsigned char>(each) & 15];
  }
  return text + "'";
}

/// What the first version wrote: two sessions, of which the second is active and the first
/// previous, with two touches each.
void write_first_version(const std::filesystem::path& path) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  ASSERT_TRUE(migrate(database, migrations().first(1)).has_value());
  sqlite3_close(database);
  const auto text = [](int id, const std::string& body) {
    return "INSERT INTO text VALUES(" + std::to_string(id) + ", '" + sha256_hex(body) + "', '" +
           body + "');";
  };
  std::string sql =
      text(1, "joints: [a, b]\n") + text(2, "robot: r 0.501\n") + text(3, "robot: r 0.499\n");
  for (int id = 1; id <= 2; ++id) {
    const std::string s = std::to_string(id);
    sql += "INSERT INTO session VALUES(" + s +
           ", 'full', 'by command', 'm', 'c', 1, 7, 2, 10, 20, 2);";
    sql += "INSERT INTO plan VALUES(" + s + ", " + hex(pack_labels(some_plan(2, 6))) + ");";
    sql += "INSERT INTO posture VALUES(" + s + ", " + hex(pack_postures(some_plan(2, 6))) + ");";
    for (int step = 0; step < 2; ++step) {
      const TouchRecord touch = some_touch(step, 6);
      sql += "INSERT INTO touch VALUES((" + s + " << 20) + " + std::to_string(step) + ", " +
             std::to_string(step) + ", 0, 0, NULL, " + std::to_string(touch.unix_ms) + ", 21.5, " +
             hex(pack_stamps(touch)) + ");";
    }
    sql += "INSERT INTO result VALUES(" + s +
           ", 20, 'improved', 'applied', 'why', 0.5, 1e-3, 2e-5,"
           " 3e-5, 2, 0, 27, " +
           std::to_string(id + 1) + ");";
    sql += "INSERT INTO json VALUES(" + s + ", '{}');";
  }
  sql += "INSERT INTO slot VALUES(0, 2, 30, 'm', 3), (1, 1, 30, 'm', 2);";
  sql += "INSERT INTO event(unix_ms, level, text) VALUES(5, 'info', 'started');";
  sql += "INSERT INTO remembered VALUES('held', 'yes');";
  with_sqlite(path, sql);
}

TEST(StoreMigration, AStoreWithoutChecksumsIsReadAsBefore) {
  const Scratch scratch;
  write_first_version(scratch.folder() / "selfcal.db");
  EXPECT_THAT(Store::open_to_read(scratch.folder()).error().what, HasSubstr("older version"));

  const auto again = Store::open(scratch.folder()).value();

  EXPECT_EQ(again.set_aside, "");
  EXPECT_EQ(again.store->slot(Slot::active).value()->robot_text, "robot: r 0.499\n");
  EXPECT_EQ(again.store->slot(Slot::previous).value()->session, 1);
  EXPECT_EQ(again.store->sessions(10)->size(), 2u);
  EXPECT_EQ(again.store->result(2).value()->json, "{}");
  EXPECT_EQ(again.store->events(10)->front().text, "started");
  EXPECT_EQ(again.store->remembered("held").value(), "yes");
  ASSERT_EQ(again.store->touches(2)->size(), 2u);
  EXPECT_EQ(again.store->touches(2)->back().before.counts, some_touch(1, 6).before.counts);
  EXPECT_EQ(again.store->plan(2)->size(), 2u);
  EXPECT_TRUE(again.store->met().empty());
  EXPECT_EQ(whole_session(*again.store, 3, true), 3);
  EXPECT_TRUE(again.store->accept(40).has_value());
}

TEST(StoreMigration, AndVerifiedFromThenOn) {
  const Scratch scratch;
  const auto path = scratch.folder() / "selfcal.db";
  write_first_version(path);
  ASSERT_EQ(Store::open(scratch.folder())->set_aside, "");
  with_sqlite(path,
              "UPDATE slot SET since_ms = 31 WHERE slot = 0;"
              "UPDATE touch SET step = 1 WHERE id = 2 << 20");
  EXPECT_THAT(
      Store::open(scratch.folder())->set_aside,
      AllOf(HasSubstr("the active parameters (session 2)"), HasSubstr("touch 0 of session 2")));
}

// The hash of a text is older than the checksums of rows.
TEST(StoreMigration, ATextThatWasDamagedBeforeIsSeen) {
  const Scratch scratch;
  const auto path = scratch.folder() / "selfcal.db";
  write_first_version(path);
  with_sqlite(path, "UPDATE text SET body = replace(body, '0.499', '0.899')");
  const auto again = Store::open(scratch.folder()).value();
  EXPECT_THAT(again.set_aside, HasSubstr("the active parameters (session 2)"));
  EXPECT_EQ(again.store->slot(Slot::active).value()->session, 1);
}

}  // namespace
}  // namespace selfcal
