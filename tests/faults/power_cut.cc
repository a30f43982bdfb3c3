// A power cut at any instant loses no touch that the store said it has.
//
// A child under the forgetful disk (preload/forgetful_vfs.cc) adds touches and tells of every one
// that is committed; it is killed, and what is on the real disk is looked at. That the disk does
// forget is shown by a child that asks SQLite not to sync.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "tests/io/scratch.h"
#include "tests/io/store_records.h"

namespace selfcal {
namespace {

constexpr int kReport = 3;  // the child's descriptor to tell of commits on
constexpr int kSteps = 240;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "child: %s\n", what.c_str());
  _exit(1);
}

void tell() {
  if (write(kReport, ".", 1) != 1) _exit(0);  // nobody listens any more
}

/// Touch after touch, session after session, until killed.
[[noreturn]] void add_touches(const std::filesystem::path& folder) {
  const auto opened = Store::open(folder);
  if (!opened) fail(opened.error().what);
  for (;;) {
    const auto id = opened->store->begin(some_session(), some_plan(kSteps, 6));
    if (!id) fail(id.error().what);
    for (int step = 0; step < kSteps; ++step) {
      if (auto done = opened->store->add(*id, some_touch(step, 6)); !done) fail(done.error().what);
      tell();
    }
    if (auto done = opened->store->finish(some_result(*id), nullptr); !done) {
      fail(done.error().what);
    }
  }
}

/// The same in a database of its own that is never synced.
[[noreturn]] void add_rows_without_sync(const std::filesystem::path& folder) {
  sqlite3* database = nullptr;
  sqlite3_open((folder / "unsynced.db").c_str(), &database);
  sqlite3_exec(database, "PRAGMA journal_mode = WAL; CREATE TABLE t(x); PRAGMA synchronous = OFF",
               nullptr, nullptr, nullptr);
  while (sqlite3_exec(database, "INSERT INTO t VALUES(1)", nullptr, nullptr, nullptr) ==
         SQLITE_OK) {
    tell();
  }
  fail(sqlite3_errmsg(database));
}

/// Takes the place of the tests in a process that was started as a child.
class Child : public testing::Environment {
 public:
  void SetUp() override {
    const char* folder = std::getenv("SELFCAL_TEST_FOLDER");
    const char* role = std::getenv("SELFCAL_TEST_CHILD");
    if (folder == nullptr || role == nullptr) return;
    if (std::string(role) == "touches") add_touches(folder);
    add_rows_without_sync(folder);
  }
};
const auto* const kChild = testing::AddGlobalTestEnvironment(new Child);

/// A running child and the end of its pipe.
struct Running {
  pid_t process = -1;
  int reports = -1;
};

Running start(const std::string& role, const std::filesystem::path& folder, int keep_seed) {
  int ends[2];
  EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
  std::vector<std::string> environment{
      "SELFCAL_TEST_CHILD=" + role, "SELFCAL_TEST_FOLDER=" + folder.string(),
      "LD_PRELOAD=" SELFCAL_FORGETFUL_VFS, "ASAN_OPTIONS=verify_asan_link_order=0"};
  if (keep_seed > 0) environment.push_back("FORGETFUL_KEEP=" + std::to_string(keep_seed));
  std::vector<char*> variables;
  for (std::string& variable : environment) variables.push_back(variable.data());
  variables.push_back(nullptr);
  std::string name = "child";
  char* arguments[] = {name.data(), nullptr};

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kReport);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  Running child{-1, ends[0]};
  EXPECT_EQ(
      posix_spawn(&child.process, "/proc/self/exe", &actions, nullptr, arguments, variables.data()),
      0);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  return child;
}

/// Bytes in the pipe within `wait`; 0 at its end or when none came.
int take_reports(int reports, std::chrono::microseconds wait) {
  pollfd descriptor{reports, POLLIN, 0};
  const timespec limit{wait.count() / 1'000'000, wait.count() % 1'000'000 * 1000};
  if (ppoll(&descriptor, 1, &limit, nullptr) != 1) return 0;
  char bytes[4096];
  return static_cast<int>(std::max<ssize_t>(0, read(reports, bytes, sizeof bytes)));
}

enum class From { start, first_commit };

/// Kills the child so long `after` an event; how many commits it told of.
int kill_after(const Running& child, From event, std::chrono::microseconds after) {
  using Clock = std::chrono::steady_clock;
  int told = 0;
  if (event == From::first_commit) {
    told = take_reports(child.reports, std::chrono::seconds(20));
    EXPECT_GT(told, 0) << "the child never committed";
  }
  const auto end = Clock::now() + after;
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    told += take_reports(child.reports,
                         std::chrono::duration_cast<std::chrono::microseconds>(end - now));
  }
  kill(child.process, SIGKILL);
  int status = 0;
  waitpid(child.process, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
  for (int more = 1; more > 0;) told += more = take_reports(child.reports, std::chrono::seconds(1));
  close(child.reports);
  return told;
}

/// Touches of all sessions, after checking that each is the one that was added.
int sound_touches(const std::filesystem::path& folder) {
  const auto store = opened(folder);
  const auto sessions = store->sessions(1'000'000).value();
  int count = 0;
  for (const SessionRecord& session : sessions) {
    const auto touches = store->touches(session.id).value();
    for (std::size_t i = 0; i < touches.size(); ++i) {
      expect_same(touches[i], some_touch(static_cast<int>(i), 6));
    }
    EXPECT_EQ(store->plan(session.id)->size(), static_cast<std::size_t>(kSteps));
    EXPECT_EQ(store->result(session.id)->has_value(), session.state == SessionState::finished);
    count += static_cast<int>(touches.size());
  }
  return count;
}

/// Kills of children one after the other on one store; SELFCAL_POWER_CUTS says how many.
void cut_power_often(bool keep_some) {
  const char* wanted = std::getenv("SELFCAL_POWER_CUTS");
  const int cuts = wanted == nullptr ? 20 : std::atoi(wanted);
  const Scratch scratch;
  std::mt19937_64 generator(11);
  std::uniform_int_distribution<int> wait(0, 60'000);
  int before = 0;
  for (int cut = 1; cut <= cuts; ++cut) {
    const Running child = start("touches", scratch.folder(), keep_some ? cut : 0);
    // Every third may die while it opens or recovers the store.
    const From event = cut % 3 == 1 ? From::start : From::first_commit;
    const int told = kill_after(child, event, std::chrono::microseconds(wait(generator)));
    const int there = sound_touches(scratch.folder());
    ASSERT_GE(there, before + told) << "cut " << cut;
    ASSERT_LE(there, before + told + 1) << "cut " << cut;  // committed, not yet told of
    before = there;
  }
  testing::Test::RecordProperty("touches", before);
}

TEST(PowerCut, LosesNoCommittedTouch) { cut_power_often(false); }

TEST(PowerCut, LosesNoCommittedTouchWhenTheDiskKeepsSomeOfTheWrites) { cut_power_often(true); }

TEST(PowerCut, ForgetsWhatWasNotSynced) {
  const Scratch scratch;
  const Running child = start("rows", scratch.folder(), 0);
  const int told = kill_after(child, From::first_commit, std::chrono::milliseconds(20));

  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((scratch.folder() / "unsynced.db").c_str(), &database), SQLITE_OK);
  sqlite3_stmt* count = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(database, "SELECT count(*) FROM t", -1, &count, nullptr), SQLITE_OK);
  ASSERT_EQ(sqlite3_step(count), SQLITE_ROW);
  EXPECT_LT(sqlite3_column_int(count, 0), told);
  sqlite3_finalize(count);
  sqlite3_close(database);
}

}  // namespace
}  // namespace selfcal
