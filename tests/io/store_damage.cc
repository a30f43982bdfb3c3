// A damaged store is set aside, never overwritten; a newer one is left alone; readers see whole
// commits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "io/files/file.h"
#include "io/store/schema.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

std::string content(const std::filesystem::path& path) {
  return read_file(path, std::size_t{1} << 30).value();
}

/// A store of a few sessions in `scratch`, all of it in the file; its bytes.
std::string bytes_of_sessions(const Scratch& scratch) {
  const auto store = opened(scratch.folder());
  for (int i = 0; i < 4; ++i) whole_session(*store, 60);
  EXPECT_TRUE(store->prune(std::int64_t{1} << 40).has_value());  // copies the log into the file
  return content(scratch.folder() / "selfcal.db");
}

void expect_set_aside(const Scratch& scratch, const std::string& damaged, int number) {
  const auto again = Store::open(scratch.folder());
  ASSERT_TRUE(again.has_value()) << again.error().what;
  const std::string name = "selfcal.db.damaged-" + std::to_string(number);
  EXPECT_THAT(again->set_aside, HasSubstr(name));
  EXPECT_EQ(content(scratch.folder() / name), damaged);
  // What was salvaged is some of the four sessions, and the new store goes on.
  EXPECT_LE(again->store->sessions(10)->size(), 4u);
  whole_session(*again->store, 3);
}

TEST(StoreDamage, OverwrittenBytesSetItAside) {
  const Scratch scratch;
  std::string bytes = bytes_of_sessions(scratch);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 9000; ++i) bytes[i] = '\x5a';
  scratch.write("selfcal.db", bytes);
  expect_set_aside(scratch, bytes, 1);
}

// Found by a fuzzer: with a write version that SQLite does not know it reads alone.
TEST(StoreDamage, AHeaderThatForbidsToWriteSetsItAsideWithAllThatItHad) {
  const Scratch scratch;
  std::string bytes = bytes_of_sessions(scratch);
  constexpr std::size_t kWriteVersion = 18;
  bytes[kWriteVersion] = 3;
  scratch.write("selfcal.db", bytes);
  std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
  const auto again = Store::open(scratch.folder());
  ASSERT_TRUE(again.has_value()) << again.error().what;
  EXPECT_THAT(again->set_aside, HasSubstr("selfcal.db.damaged-1"));
  EXPECT_EQ(again->store->sessions(10)->size(), 4u);
  whole_session(*again->store, 3);
}

// Found by a fuzzer: rows could be read, and no new session could be begun.
TEST(StoreDamage, AReferenceToWhatIsNotThereSetsItAside) {
  for (const std::string changed : {"REFERENCES sessiom(id)", "REFERENCES session(ie)"}) {
    const Scratch scratch;
    std::string bytes = bytes_of_sessions(scratch);
    const std::size_t at = bytes.find("REFERENCES session(id)");
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, changed.size(), changed);
    scratch.write("selfcal.db", bytes);
    std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
    expect_set_aside(scratch, bytes, 1);
  }
}

TEST(StoreDamage, ATruncatedFileIsSetAside) {
  const Scratch scratch;
  const std::string bytes = bytes_of_sessions(scratch);
  const std::string cut = bytes.substr(0, bytes.size() / 2 - 1000);
  scratch.write("selfcal.db", cut);
  expect_set_aside(scratch, cut, 1);
}

TEST(StoreDamage, GarbageIsSetAsideAndNeverOverAnother) {
  const Scratch scratch;
  std::mt19937_64 generator(5);
  for (int number = 1; number <= 3; ++number) {
    std::string garbage;
    while (garbage.size() < 20000) garbage += static_cast<char>(generator() & 255);
    scratch.write("selfcal.db", garbage);
    expect_set_aside(scratch, garbage, number);
  }
}

TEST(StoreDamage, TheLogGoesAsideWithTheStore) {
  const Scratch scratch;
  bytes_of_sessions(scratch);
  scratch.write("selfcal.db", std::string(20000, 'x'));
  scratch.write("selfcal.db-wal", "a log");
  ASSERT_TRUE(Store::open(scratch.folder()).has_value());
  EXPECT_EQ(content(scratch.folder() / "selfcal.db.damaged-1-wal"), "a log");
}

// Any page may break; the store is then set aside, or opens and answers. It never crashes and never
// fails to start.
TEST(StoreDamage, AnyBrokenPageIsSetAsideOrAnswered) {
  const Scratch scratch;
  const std::string whole = bytes_of_sessions(scratch);
  std::mt19937_64 generator(7);
  for (int round = 0; round < 40; ++round) {
    std::string bytes = whole;
    const std::size_t from = 100 + generator() % (bytes.size() - 700);
    for (std::size_t i = from; i < from + 600; ++i) bytes[i] = static_cast<char>(generator() & 255);
    scratch.write("selfcal.db", bytes);
    std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
    const auto again = Store::open(scratch.folder());
    ASSERT_TRUE(again.has_value()) << again.error().what;
    const auto sessions = again->store->sessions(10);
    if (!sessions) continue;
    for (const SessionRecord& session : *sessions) {
      (void)again->store->touches(session.id);
      (void)again->store->plan(session.id);
      (void)again->store->result(session.id);
    }
  }
}

// Its plan, its touches and its result may be left, and a slot that came from it.
TEST(StoreDamage, ASessionNeverGetsTheNumberOfOneThatIsLost) {
  const Scratch scratch;
  std::string bytes = bytes_of_sessions(scratch);
  const std::size_t table = bytes.find("CREATE TABLE session (");
  ASSERT_NE(table, std::string::npos);
  bytes[table] = 'X';
  scratch.write("selfcal.db", bytes);
  std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
  const auto again = Store::open(scratch.folder());
  ASSERT_TRUE(again.has_value()) << again.error().what;
  EXPECT_TRUE(again->store->sessions(10)->empty());
  EXPECT_EQ(whole_session(*again->store, 3), 5);
}

TEST(StoreVersion, ANewerStoreIsRefusedAndLeftAlone) {
  const Scratch scratch;
  whole_session(*opened(scratch.folder()), 3);
  const std::filesystem::path path = scratch.folder() / "selfcal.db";
  with_sqlite(path, "PRAGMA user_version = 999");
  const std::string before = content(path);
  for (const std::string& what : {Store::open(scratch.folder()).error().what,
                                  Store::open_to_read(scratch.folder()).error().what}) {
    EXPECT_THAT(what, HasSubstr("selfcal.db: was written by a newer program (version 999"));
  }
  EXPECT_EQ(content(path), before);
}

TEST(StoreVersion, AFileOfVersionZeroIsBroughtUpToDate) {
  const Scratch scratch;
  with_sqlite(scratch.folder() / "selfcal.db", "CREATE TABLE before_versions(x)");
  EXPECT_THAT(Store::open_to_read(scratch.folder()).error().what, HasSubstr("older version"));
  EXPECT_EQ(whole_session(*opened(scratch.folder()), 3), 1);
  EXPECT_TRUE(Store::open_to_read(scratch.folder()).has_value());
}

TEST(StoreVersion, MigratesFromWhereTheFileStandsAndOnlyAsAWhole) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(":memory:", &database), SQLITE_OK);
  const Migration list[] = {"CREATE TABLE a(x); INSERT INTO a VALUES(1);",
                            "ALTER TABLE a ADD COLUMN y; UPDATE a SET y = x + 1;",
                            "CREATE TABLE b(x); INSERT INTO nowhere VALUES(1);"};
  ASSERT_TRUE(migrate(database, std::span(list).first(1)).has_value());
  EXPECT_EQ(version(database).value(), 1);
  ASSERT_TRUE(migrate(database, std::span(list).first(2)).has_value());
  EXPECT_EQ(version(database).value(), 2);

  EXPECT_THAT(migrate(database, list).error().what, HasSubstr("no such table: nowhere"));

  EXPECT_EQ(version(database).value(), 2);
  EXPECT_NE(sqlite3_exec(database, "SELECT * FROM b", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, "SELECT y FROM a", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_FALSE(migrate(database, std::span(list).first(1)).has_value());
  sqlite3_close(database);
}

TEST(StoreReader, SeesWhatIsCommittedWhileAnotherWritesAndWritesNothing) {
  const Scratch scratch;
  const auto writer = opened(scratch.folder());
  const std::int64_t id = writer->begin(some_session(), some_plan(30, 6)).value();
  const auto reader = Store::open_to_read(scratch.folder()).value();
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(writer->add(id, some_touch(i, 6)).has_value());
    EXPECT_EQ(reader->touches(id)->size(), static_cast<std::size_t>(i + 1));
  }
  EXPECT_THAT(reader->add(EventRecord{0, 1, "info", "x"}).error().what, HasSubstr("readonly"));
  EXPECT_FALSE(reader->begin(some_session(), {}).has_value());
}

TEST(StoreReader, FailsWhereThereIsNoStoreAndMakesNone) {
  const Scratch scratch;
  const auto reader = Store::open_to_read(scratch.folder());
  ASSERT_FALSE(reader.has_value());
  EXPECT_THAT(reader.error().what, HasSubstr("holds no selfcal.db: the service has not run"));
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
  const auto writer = Store::open(scratch.folder() / "none" / "deeper");
  ASSERT_FALSE(writer.has_value());
  EXPECT_EQ(writer.error().exit_status, kDeviceFailed);
}

TEST(StoreReader, ReadsAsAUserWhoMayNotWriteWhetherTheServiceRunsOrNot) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const Scratch scratch;
  auto store = opened(scratch.folder());
  whole_session(*store, 3);
  const auto as_nobody = [&] {
    const pid_t child = fork();
    if (child == 0) {
      if (setuid(65534) != 0) _exit(2);
      const auto reader = Store::open_to_read(scratch.folder());
      if (!reader) _exit(1);
      const auto touches = (*reader)->touches(1);
      _exit(touches && touches->size() == 3 ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
  };
  EXPECT_EQ(as_nobody(), 0);
  store.reset();
  EXPECT_EQ(as_nobody(), 0);
}

}  // namespace
}  // namespace selfcal
