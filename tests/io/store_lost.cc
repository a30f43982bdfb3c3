// A store that was lost is not taken for that of a new robot; one that is new is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/store/folder.h"
#include "tests/io/scratch.h"
#include "tests/io/store_content.h"

namespace selfcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string said_of(const Scratch& scratch) {
  const auto again = Store::open(scratch.folder());
  EXPECT_TRUE(again.has_value()) << again.error().what;
  return again ? again->set_aside : "";
}

TEST(StoreLost, ANewFolderIsANewRobot) {
  const Scratch scratch;
  EXPECT_EQ(said_of(scratch), "");
  EXPECT_EQ(said_of(scratch), "");
}

TEST(StoreFolder, IsOfOneRobot) {
  const Scratch scratch;
  EXPECT_TRUE(may_own_folder(scratch.folder(), "a").has_value()) << "nobody's yet";
  ASSERT_TRUE(own_folder(scratch.folder(), "a").has_value());
  EXPECT_TRUE(own_folder(scratch.folder(), "a").has_value());
  const auto other = own_folder(scratch.folder(), "b");
  ASSERT_FALSE(other.has_value());
  EXPECT_THAT(other.error().what,
              AllOf(HasSubstr(scratch.folder().string()), HasSubstr("of robot 'a', not of 'b'")));
  EXPECT_FALSE(may_own_folder(scratch.folder(), "b").has_value());
}

TEST(StoreLost, AFileOfNoBytesIsSaidAndANewStoreBegun) {
  const Scratch scratch;
  fill(*opened(scratch.folder()));
  std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
  std::filesystem::resize_file(scratch.folder() / "selfcal.db", 0);

  const auto again = Store::open(scratch.folder()).value();

  EXPECT_THAT(again.set_aside, AllOf(HasSubstr("selfcal.db: was emptied (0 bytes)"),
                                     HasSubstr("selfcal.db.damaged-1"), HasSubstr("a new store")));
  EXPECT_TRUE(again.store->sessions(1)->empty());
  ASSERT_EQ(again.store->damage()->size(), 1u);
  EXPECT_EQ(again.store->damage()->front().place, "store");
  EXPECT_THAT(again.store->damage()->front().what, HasSubstr("emptied"));
}

// A store gets its name once it is whole, so that no start of ours leaves such a file.
TEST(StoreLost, AFileOfNoBytesInANewFolderIsSaidToo) {
  const Scratch scratch;
  scratch.write("selfcal.db", "");
  EXPECT_THAT(Store::open_to_read(scratch.folder()).error().what, HasSubstr("was emptied"));
  EXPECT_THAT(said_of(scratch), HasSubstr("was emptied"));
  EXPECT_EQ(said_of(scratch), "");
}

TEST(StoreLost, TheLogOfAnEmptiedStoreGoesAsideWithIt) {
  const Scratch scratch;
  scratch.write("selfcal.db", "");
  scratch.write("selfcal.db-wal", "a log");
  EXPECT_THAT(said_of(scratch), HasSubstr("was emptied"));
  EXPECT_EQ(read_file(scratch.folder() / "selfcal.db.damaged-1-wal", 100).value(), "a log");
}

TEST(StoreLost, AStoreThatIsGoneIsSaid) {
  const Scratch scratch;
  fill(*opened(scratch.folder()));
  for (const char* name : {"selfcal.db", "selfcal.db-wal", "selfcal.db-shm"}) {
    std::filesystem::remove(scratch.folder() / name);
  }
  EXPECT_THAT(said_of(scratch), AllOf(HasSubstr("is gone"), HasSubstr("selfcal.made")));
  EXPECT_EQ(said_of(scratch), "");
}

TEST(StoreLost, ALeftOverLogOrExportShowsThatThereWasOne) {
  for (const char* name : {"selfcal.db-wal", "active.robot.yaml"}) {
    const Scratch scratch;
    scratch.write(name, "something");
    EXPECT_THAT(said_of(scratch), HasSubstr("is gone")) << name;
    EXPECT_EQ(said_of(scratch), "") << name;
  }
}

// A power cut while the first store was made.
TEST(StoreLost, AStoreThatWasNeverMadeIsNotMissed) {
  const Scratch scratch;
  scratch.write("selfcal.db.new", "half of a page");
  scratch.write("selfcal.db.new-journal", "a journal");
  EXPECT_EQ(said_of(scratch), "");
  EXPECT_FALSE(std::filesystem::exists(scratch.folder() / "selfcal.db.new"));
  EXPECT_FALSE(std::filesystem::exists(scratch.folder() / "selfcal.db.new-journal"));
}

// A power cut between a damaged store's going aside and the naming of the one with its rows.
TEST(StoreLost, WhatWasReadOfADamagedStoreIsNotLostBeforeItHasItsName) {
  const Scratch scratch;
  std::string content;
  {
    const auto store = opened(scratch.folder());
    fill(*store);
    content = content_of(*store);
  }
  with_sqlite(scratch.folder() / "selfcal.db", "PRAGMA journal_mode = DELETE");
  std::filesystem::rename(scratch.folder() / "selfcal.db", scratch.folder() / "selfcal.db.new");
  scratch.write("selfcal.db.damaged-1", "what was damaged");

  const auto again = Store::open(scratch.folder()).value();

  EXPECT_THAT(again.set_aside, HasSubstr("the one that was made in its place is used"));
  EXPECT_EQ(content_of(*again.store), content);
  EXPECT_FALSE(std::filesystem::exists(scratch.folder() / "selfcal.db.new"));
}

TEST(StoreLost, AFileCutAnywhereIsSaidOrLacksNothing) {
  const Scratch scratch;
  std::string content;
  {
    const auto store = opened(scratch.folder());
    fill(*store);
    content = content_of(*store);
    ASSERT_TRUE(store->prune(1 << 30).has_value());
  }
  const std::string whole = read_file(scratch.folder() / "selfcal.db", 1 << 30).value();
  int said = 0, tried = 0;
  for (std::size_t size = 1; size < whole.size(); size += size < 2048 ? 255 : 1777) {
    std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
    scratch.write("selfcal.db", whole.substr(0, size));
    const auto again = Store::open(scratch.folder());
    ASSERT_TRUE(again.has_value()) << again.error().what;
    ++tried;
    said += again->set_aside.empty() ? 0 : 1;
    EXPECT_TRUE(!again->set_aside.empty() || content_of(*again->store) == content) << size;
  }
  EXPECT_GE(said, tried - 3);  // three of the cuts are in the last page, which may hold nothing
}

TEST(StoreLost, AnOlderCopyOfTheStoreIsSaidOnce) {
  const Scratch scratch;
  std::string older;
  {
    const auto store = opened(scratch.folder());
    fill(*store);
    ASSERT_TRUE(store->prune(1 << 30).has_value());
    older = read_file(scratch.folder() / "selfcal.db", 1 << 30).value();
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(store->remember("use", std::to_string(i)).has_value());
  }
  std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
  scratch.write("selfcal.db", older);
  EXPECT_THAT(said_of(scratch), HasSubstr("lacks the last 3 changes"));
  EXPECT_EQ(said_of(scratch), "");
}

TEST(StoreLost, AMarkThatCannotBeReadSaysNothing) {
  const Scratch scratch;
  fill(*opened(scratch.folder()));
  for (const char* mark : {"", "99999999999999999999 changes", "a mark of another program"}) {
    scratch.write("selfcal.made", mark);
    EXPECT_EQ(said_of(scratch), "") << mark;
  }
}

TEST(StoreLost, AFileOfZerosIsSaid) {
  const Scratch scratch;
  fill(*opened(scratch.folder()));
  for (const std::size_t size : {std::size_t{4096}, std::size_t{40960}}) {
    std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
    scratch.write("selfcal.db", std::string(size, '\0'));
    EXPECT_NE(said_of(scratch), "") << size;
  }
}

TEST(StoreLost, ADatabaseWithoutTablesIsSaid) {
  const Scratch scratch;
  fill(*opened(scratch.folder()));
  std::filesystem::remove(scratch.folder() / "selfcal.db");
  std::filesystem::remove(scratch.folder() / "selfcal.db-wal");
  with_sqlite(scratch.folder() / "selfcal.db", "PRAGMA journal_mode = WAL");
  EXPECT_THAT(said_of(scratch), HasSubstr("was emptied"));
  EXPECT_EQ(said_of(scratch), "");
}

}  // namespace
}  // namespace selfcal
