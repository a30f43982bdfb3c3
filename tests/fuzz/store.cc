// The bytes of the store's file: a whole store with some of them changed, or any file. What is
// damaged is never told as what it says.
#include "io/store/store.h"

#include <set>

#include "app/report/past.h"
#include "io/files/file.h"
#include "io/store/folder.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

constexpr int kJoints = 3, kSteps = 4;

std::vector<StepRecord> plan_of_session() {
  std::vector<StepRecord> plan(kSteps);
  for (int i = 0; i < kSteps; ++i) {
    StepRecord& step = plan[static_cast<std::size_t>(i)];
    step.index = i;
    step.set = "table";
    step.start = step.touch = step.end = {0.1 * i, 0.2, -0.3};
    if (i % 2 == 1) step.way = {step.start};
  }
  return plan;
}

std::string robot_of_session(int n) {
  return "robot: arm\nkind: serial\nframes:\n  - {name: j1, joint: revolute, d: 0." +
         std::to_string(n) + "}\n";
}

/// Runs a session to its result; the robot becomes the candidate.
void run_session(Store& store, int n) {
  SessionRecord session;
  session.kind = "full";
  session.reason = "asked";
  session.model_hash = "hash";
  session.config = "joints: [a, b, c]\nsets: {}\n";
  session.started_ms = 1'790'000'000'000 + n;
  const std::int64_t id = store.begin(session, plan_of_session()).value();
  for (int i = 0; i < kSteps; ++i) {
    TouchRecord touch;
    touch.step = i;
    touch.before.joints = touch.after.joints = kJoints;
    touch.before.counts[0] = 1000 * n + i;
    promise(store.add(id, touch).has_value(), "no touch");
  }
  ResultRecord result;
  result.session = id;
  result.answer = ResultAnswer::improved;
  result.decision = ResultDecision::candidate;
  result.json = "{\"answer\": \"improved\"}";
  result.robot_text = robot_of_session(n);
  const SlotRecord candidate{id, 1'790'000'000'000, "hash", result.robot_text};
  promise(store.finish(result, &candidate).has_value(), "no result");
}

/// The file of a store with two calibrations, a candidate, a session that goes on, and a log.
std::string whole_store() {
  const auto folder = given_folder().path() / "whole";
  std::filesystem::create_directories(folder);
  {
    const auto opened = Store::open(folder);
    promise(opened.has_value(), opened ? "" : opened.error().what);
    Store& store = *opened->store;
    for (int n = 1; n <= 3; ++n) {
      run_session(store, n);
      if (n < 3) promise(store.accept(n).has_value(), "not accepted");
    }
    SessionRecord open;
    open.kind = "full";
    promise(store.begin(open, plan_of_session()).has_value(), "not begun");
    promise(store.add(EventRecord{0, 1, "info", "begun"}).has_value(), "no event");
    promise(store.remember("use", "12.5").has_value(), "not remembered");
  }
  return read_file(store_in(folder), 16 << 20).value();
}

std::string changed_store(Bytes& bytes) {
  static const std::string kWhole = whole_store();
  std::string file = kWhole;
  while (!bytes.empty()) {
    const std::size_t place = bytes.take<std::uint32_t>() % file.size();
    const std::uint8_t what = bytes.byte();
    if (what == 0xff)
      file.resize(std::max<std::size_t>(place, 1));
    else if (what == 0xfe)
      file.replace(place, 64, file, bytes.take<std::uint32_t>() % file.size(), 64);
    else
      file[place] = static_cast<char>(what ^ bytes.byte());
  }
  return file;
}

/// Of every session what it made is told as it was made, or not at all.
void expect_nothing_wrong(Store& store) {
  static const std::set<std::string> kRobots = {"", robot_of_session(1), robot_of_session(2),
                                                robot_of_session(3)};
  for (const Slot slot : {Slot::active, Slot::previous, Slot::candidate})
    if (const auto held = store.slot(slot); held && *held)
      promise(kRobots.contains((*held)->robot_text), "parameters that nobody found");
  for (std::int64_t id = 1; id <= 5; ++id) {
    if (const auto result = store.result(id); result && *result)
      promise(kRobots.contains((*result)->robot_text), "a robot that nobody found");
    if (const auto plan = store.plan(id))
      for (const StepRecord& step : *plan)
        promise(step.set == "table" && (step.touch.size() == kJoints || step.touch.empty()),
                "a step that nobody planned: " + step.set);
    if (const auto touches = store.touches(id))
      for (const TouchRecord& touch : *touches)
        promise(touch.before.joints == kJoints && touch.step < kSteps, "a touch that nobody made");
  }
  if (const auto past = read_past(store, 10))
    for (const Past& each : *past) promise(!record_of(each).empty(), "a session without a word");
  (void)read_calibrations(store);
  (void)store.events(10);
  (void)store.damage();
}

void try_store(Bytes& bytes) {
  const bool any = bytes.byte() == 'S';  // "SQLite format 3" or nearly
  const auto folder = given_folder().path() / "store";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::string file;
  if (any) {
    file = "S";
    while (!bytes.empty()) file.push_back(static_cast<char>(bytes.byte()));
  } else {
    file = changed_store(bytes);
  }
  given_folder().write("store/selfcal.db", file);
  if (const auto read = Store::open_to_read(folder)) {
    if (!any) expect_nothing_wrong(**read);
  }
  const auto opened = Store::open(folder);
  if (!opened) {
    promise(!opened.error().what.empty(), "refused without a word");
    return;
  }
  if (!any) expect_nothing_wrong(*opened->store);
  // It must be of use again.
  SessionRecord next;
  next.kind = "check";
  const auto begun = opened->store->begin(next, plan_of_session());
  promise(any || begun, begun ? "" : "a store that takes no session: " + begun.error().what);
  (void)opened->store->prune(10'000);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::Bytes bytes(data, size);
  selfcal::try_store(bytes);
  return 0;
}
