// A power cut before every single thing that is done to the disk, one after the other: the store
// then has what it said it has, and at most the change that was under way; a plain file has its old
// content or its new one, whole.
//
// A child lives a short life with one of the preloaded disks and tells of each change that is done;
// it is cut off before its first access, its second, and so on until it lives to the end.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

#include "io/files/file.h"
#include "tests/io/scratch.h"
#include "tests/io/store_records.h"

namespace selfcal {
namespace {

constexpr int kTold = 3;  // the child's descriptor to tell of changes on

/// The changes of a store's life, in order.
std::vector<std::function<bool(Store&)>> changes_of_a_store() {
  std::vector<std::function<bool(Store&)>> changes;
  const auto session = [&](std::int64_t id, int touches) {
    changes.emplace_back(
        [](Store& s) { return s.begin(some_session(), some_plan(3, 6)).has_value(); });
    for (int step = 0; step < touches; ++step)
      changes.emplace_back([=](Store& s) { return s.add(id, some_touch(step, 6)).has_value(); });
  };
  const auto finished = [&](std::int64_t id) {
    changes.emplace_back([=](Store& s) {
      const ResultRecord result = some_result(id);
      const SlotRecord candidate = candidate_of(result);
      return s.finish(result, &candidate).has_value();
    });
  };
  session(1, 3);
  finished(1);
  changes.emplace_back([](Store& s) { return s.accept(1).has_value(); });
  changes.emplace_back([](Store& s) { return s.remember("held", "yes").has_value(); });
  session(2, 2);
  finished(2);
  changes.emplace_back([](Store& s) { return s.accept(2).has_value(); });
  changes.emplace_back([](Store& s) { return s.roll_back(3).has_value(); });
  session(3, 1);
  changes.emplace_back(
      [](Store& s) { return s.set_state(3, SessionState::aborted, 4).has_value(); });
  changes.emplace_back([](Store& s) {
    return s.add(EventRecord{.id = 0, .unix_ms = 5, .level = "info", .text = "e"}).has_value();
  });
  changes.emplace_back([](Store& s) { return s.prune(1).has_value(); });
  return changes;
}

constexpr int kContents = 6;

/// Longer than a page, and of another length each time.
std::string content(int n) { return std::string(5000 + 100 * n, static_cast<char>('a' + n)); }

[[noreturn]] void live_on(const std::filesystem::path& folder, const std::string& role) {
  const auto told = [] {
    if (::write(kTold, ".", 1) != 1) _exit(2);
  };
  if (role == "store") {
    const auto opened = Store::open(folder);
    if (!opened) _exit(3);
    for (const auto& change : changes_of_a_store()) {
      if (!change(*opened->store)) _exit(4);
      told();
    }
  } else {
    for (int n = 1; n <= kContents; ++n) {
      if (!write_file_atomically(folder / "active.robot.yaml", content(n))) _exit(5);
      told();
    }
  }
  _exit(0);
}

/// Takes the place of the tests in a process that was started as such a child.
class ShortLife : public testing::Environment {
 public:
  void SetUp() override {
    const char* role = std::getenv("SELFCAL_TEST_LIFE");
    const char* folder = std::getenv("SELFCAL_TEST_FOLDER");
    if (role != nullptr && folder != nullptr) live_on(folder, role);
  }
};
const auto* const kShortLife = testing::AddGlobalTestEnvironment(new ShortLife);

struct Lived {
  std::size_t told = 0;
  bool cut = false;
};

Lived live(const std::string& role, const std::filesystem::path& folder,
           std::vector<std::string> environment) {
  environment.insert(environment.end(),
                     {"SELFCAL_TEST_LIFE=" + role, "SELFCAL_TEST_FOLDER=" + folder.string(),
                      "ASAN_OPTIONS=verify_asan_link_order=0"});
  std::vector<char*> variables;
  for (std::string& variable : environment) variables.push_back(variable.data());
  variables.push_back(nullptr);
  int ends[2];
  EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kTold);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  std::string name = "child";
  char* arguments[] = {name.data(), nullptr};
  pid_t process = -1;
  EXPECT_EQ(posix_spawn(&process, "/proc/self/exe", &actions, nullptr, arguments, variables.data()),
            0);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  Lived lived;
  char bytes[64];
  for (ssize_t got = 0; (got = read(ends[0], bytes, sizeof bytes)) > 0;)
    lived.told += static_cast<std::size_t>(got);
  close(ends[0]);
  int status = 0;
  waitpid(process, &status, 0);
  lived.cut = WIFSIGNALED(status);
  EXPECT_TRUE(lived.cut || WEXITSTATUS(status) == 0) << "the child said " << WEXITSTATUS(status);
  return lived;
}

/// All that a store has, in words, touch by touch.
std::string told_of(Store& store) {
  std::ostringstream words;
  const auto sessions = store.sessions(100);
  for (const SessionRecord& session : *sessions) {
    words << "session " << session.id << " " << static_cast<int>(session.state) << " of "
          << session.steps << ":";
    const auto touches = store.touches(session.id);
    for (const TouchRecord& touch : *touches)
      words << " " << touch.step << "/" << touch.edge << "/" << touch.before.counts[5];
    const auto result = store.result(session.id).value();
    if (result) words << ", " << static_cast<int>(result->decision) << " " << result->json.size();
    words << "\n";
  }
  for (const Slot slot : {Slot::active, Slot::previous, Slot::candidate})
    if (const auto record = store.slot(slot).value())
      words << to_string(slot) << " " << record->session << " " << record->robot_text;
  words << store.remembered("held").value() << "\n";
  const auto events = store.events(100);
  for (const EventRecord& event : *events) words << event.text << "\n";
  const auto damages = store.damage();
  for (const DamageRecord& damage : *damages) words << "DAMAGE " << damage.what;
  return words.str();
}

/// What there is before the first change and after each.
std::vector<std::string> stages() {
  const Scratch scratch;
  const auto store = opened(scratch.folder());
  std::vector<std::string> all{told_of(*store)};
  for (const auto& change : changes_of_a_store()) {
    EXPECT_TRUE(change(*store));
    all.push_back(told_of(*store));
  }
  return all;
}

/// Cuts off before each access, until one life is whole; `keeps`: what of the unsynced writes
/// reaches the disk.
int cut_at_every_access(const std::string& keeps) {
  const std::vector<std::string> wanted = stages();
  for (int cut = 1;; ++cut) {
    const Scratch scratch;
    std::vector<std::string> environment{"LD_PRELOAD=" SELFCAL_FORGETFUL_VFS,
                                         "FORGETFUL_CUT=" + std::to_string(cut)};
    if (!keeps.empty())
      environment.push_back("FORGETFUL_KEEP=" + (keeps == "some" ? std::to_string(cut) : keeps));
    const Lived lived = live("store", scratch.folder(), environment);
    const auto store = opened(scratch.folder());
    const std::string there = told_of(*store);
    if (!lived.cut) {
      EXPECT_EQ(there, wanted.back());
      return cut - 1;
    }
    const bool as_told = there == wanted[lived.told];
    const bool one_more = lived.told + 1 < wanted.size() && there == wanted[lived.told + 1];
    EXPECT_TRUE(as_told || one_more)
        << "cut " << cut << " after " << lived.told << " changes, there is\n"
        << there;
    if (testing::Test::HasFailure()) return cut;
  }
}

TEST(EveryWrite, OfAStoreMayBeTheLastOneWhenNothingElseReachesTheDisk) {
  const int cuts = cut_at_every_access("");
  std::printf("%d cuts\n", cuts);
  EXPECT_GT(cuts, 50);
}

TEST(EveryWrite, OfAStoreMayBeTheLastOneWhenAllOfThemReachTheDisk) {
  EXPECT_GT(cut_at_every_access("all"), 50);
}

TEST(EveryWrite, OfAStoreMayBeTheLastOneWhenSomeReachTheDiskInAnyOrder) {
  EXPECT_GT(cut_at_every_access("some"), 50);
}

TEST(EveryWrite, OfAPlainFileLeavesTheOldContentOrTheNew) {
  for (const char* loses : {"nothing", "data", "names", "both"}) {
    int cuts = 0;
    for (bool cut = true; cut; ++cuts) {
      const Scratch scratch;
      const std::filesystem::path path = scratch.write("active.robot.yaml", content(0));
      const Lived lived = live(
          "file", scratch.folder(),
          {"LD_PRELOAD=" SELFCAL_FORGETFUL_FILES, "FORGETFUL_FOLDER=" + scratch.folder().string(),
           std::string("FORGETFUL_LOSES=") + loses, "FORGETFUL_CUT=" + std::to_string(cuts + 1)});
      const std::string there = read_file(path, 1 << 20).value();
      const int told = static_cast<int>(lived.told);
      EXPECT_TRUE(there == content(told) || (lived.cut && there == content(told + 1)))
          << loses << ", cut " << cuts + 1 << " after " << told << ": " << there.size() << " bytes";
      cut = lived.cut;
    }
    // Made, written, synced, renamed, and the folder synced, each time.
    EXPECT_EQ(cuts - 1, 5 * kContents) << loses;
  }
}

}  // namespace
}  // namespace selfcal
