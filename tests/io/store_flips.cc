// One byte of the file changes, any of them: what the store then gives back is what was put in, or
// it says that it is damaged. It never gives back something else without a word.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/io/scratch.h"
#include "tests/io/store_content.h"

namespace selfcal {
namespace {

/// What came of the flips.
struct Tally {
  int same = 0, said = 0, refused = 0, silent = 0, kept_active = 0;
};

/// A number of repetitions: `fallback` unless the environment says otherwise.
int flips(int fallback) {
  const char* wanted = std::getenv("SELFCAL_FLIPS");
  return wanted == nullptr ? fallback : std::atoi(wanted);
}

class StoreFlips : public testing::Test {
 protected:
  StoreFlips() {
    const auto store = opened(scratch_.folder());
    fill(*store);
    content_ = content_of(*store);
    EXPECT_TRUE(store->prune(1 << 30).has_value());  // copies the log into the file
  }

  void SetUp() override { bytes_ = read_file(scratch_.folder() / "selfcal.db", 1 << 30).value(); }

  /// Puts the file with another byte in its place, and nothing else but the mark beside it.
  void put(std::size_t at, unsigned char mask) {
    for (const auto& file : std::filesystem::directory_iterator(scratch_.folder())) {
      if (file.path().filename() != "selfcal.made") std::filesystem::remove(file.path());
    }
    std::string changed = bytes_;
    changed[at] = static_cast<char>(changed[at] ^ mask);
    scratch_.write("selfcal.db", changed);
  }

  void count(const std::string& content, bool said, std::size_t at) {
    if (said) {
      ++tally_.said;
    } else if (content == content_) {
      ++tally_.same;
    } else {
      ++tally_.silent;
      ADD_FAILURE() << "byte " << at << " changed what is read, and nobody said so";
    }
  }

  void print(const char* who) const {
    std::printf(
        "%s, %zu bytes: %d flips: %d read the same, %d said so, %d refused to open, "
        "%d silent\n",
        who, bytes_.size(), tally_.same + tally_.said + tally_.refused + tally_.silent, tally_.same,
        tally_.said, tally_.refused, tally_.silent);
  }

  const Scratch scratch_;
  std::string content_, bytes_;
  Tally tally_;
};

TEST_F(StoreFlips, ChangeNothingWithoutAWord) {
  std::mt19937_64 random(3);
  for (int i = flips(300); i > 0; --i) {
    const std::size_t at = random() % bytes_.size();
    put(at, static_cast<unsigned char>(1 + random() % 255));
    const auto again = Store::open(scratch_.folder());
    if (!again) {
      ++tally_.refused;
      continue;
    }
    const std::string content = content_of(*again->store);
    count(content, !again->set_aside.empty() || !again->store->met().empty(), at);
    const auto active = again->store->slot(Slot::active).value();
    tally_.kept_active += active && active->robot_text == kRobotText;
  }
  print("the service");
  std::printf("active parameters kept in %d\n", tally_.kept_active);
  EXPECT_GT(tally_.said, 0);
  EXPECT_EQ(tally_.silent, 0);
}

TEST_F(StoreFlips, ChangeNothingForAReaderWithoutAWord) {
  std::mt19937_64 random(4);
  for (int i = flips(300); i > 0; --i) {
    const std::size_t at = random() % bytes_.size();
    put(at, static_cast<unsigned char>(1U << (random() % 8)));
    const auto reader = Store::open_to_read(scratch_.folder());
    if (!reader) {
      ++tally_.refused;
      continue;
    }
    const std::string content = content_of(**reader);
    count(content, !(*reader)->met().empty(), at);
  }
  print("a reader");
  EXPECT_GT(tally_.said, 0);
  EXPECT_EQ(tally_.silent, 0);
}

// As a power cut leaves it: the last changes stand in the log alone, which SQLite reads up to the
// first page that is damaged, and no further.
TEST(StoreLog, ChangesNothingWithoutAWordWhereItIsDamaged) {
  const Scratch scratch;
  std::string content, log, bytes, mark;
  {
    const auto store = opened(scratch.folder());
    fill(*store);
    content = content_of(*store);
    bytes = read_file(scratch.folder() / "selfcal.db", 1 << 30).value();
    log = read_file(scratch.folder() / "selfcal.db-wal", 1 << 30).value();
    mark = read_file(scratch.folder() / "selfcal.made", 4096).value();
  }
  std::mt19937_64 random(5);
  int same = 0, said = 0;
  for (int i = flips(200); i > 0; --i) {
    for (const auto& file : std::filesystem::directory_iterator(scratch.folder())) {
      std::filesystem::remove(file.path());
    }
    std::string changed = log;
    // The first ones in the head of the log, which counts for all of it.
    const std::size_t at = i <= 32 ? static_cast<std::size_t>(i) - 1 : random() % log.size();
    changed[at] = static_cast<char>(changed[at] ^ (1 + random() % 255));
    scratch.write("selfcal.db", bytes);
    scratch.write("selfcal.db-wal", changed);
    scratch.write("selfcal.made", mark);
    const auto again = Store::open(scratch.folder());
    ASSERT_TRUE(again.has_value()) << again.error().what;
    const bool equal = content_of(*again->store) == content;
    same += equal && again->set_aside.empty();
    said += !again->set_aside.empty();
    EXPECT_TRUE(equal || !again->set_aside.empty()) << "byte " << at << " of the log";
  }
  std::printf("log of %zu bytes: %d read the same, %d said so\n", log.size(), same, said);
  EXPECT_GT(said, 0);
}

}  // namespace
}  // namespace selfcal
