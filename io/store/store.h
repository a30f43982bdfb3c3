// Everything the service must not lose, in one SQLite file: touches, plans, results, slots, events.
//
// Every function that writes returns only when the change is on the disk (WAL, synchronous=FULL),
// and each is one transaction: after a power cut the store has all of it or nothing.
//
//   session    a full calibration or a quick check, from its plan to its end
//   step       one planned touch: where to go, which surface, to fit or to check
//   touch      what came of one attempt: raw counts before and after the edge, or why it failed
//   slot       robot parameters that are in use (active), were (previous), may be (candidate)
//   event      a line of the log that a person may need in a year
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/outcome.h"
#include "io/ports.h"
#include "io/result.h"

struct sqlite3;

namespace selfcal {

struct StepRecord {
  int index = 0;  ///< from 0
  std::string set, group;
  bool check = false;                     ///< kept aside to judge
  bool via_home = false;                  ///< travel there through the home configuration
  std::vector<double> start, touch, end;  ///< readings: free, nominal contact, farthest (rad or m)
};

enum class TouchOutcome : std::uint8_t {
  taken = 0,
  put_aside = 1,
  differs = 2,  ///< from the good ones of its step before it: none of them counts
};

struct TouchRecord {
  int step = 0, attempt = 0;  ///< both from 0
  TouchOutcome outcome = TouchOutcome::taken;
  std::string why;  ///< of a touch put aside
  std::int64_t unix_ms = 0;
  Nanoseconds edge = 0;         ///< the trigger's own stamp
  EncoderSample before, after;  ///< the samples around it; equal when the robot was at rest
  double temperature = 0;       ///< °C; NaN when not known
};

enum class SessionState : std::uint8_t {
  collecting = 0,  ///< has a plan; touches are coming in
  collected = 1,   ///< every step is done
  finished = 2,    ///< has a result
  aborted = 3,     ///< ended early; what was collected is kept
};

struct SessionRecord {
  std::int64_t id = 0;
  std::string kind;    ///< "full" or "check"
  std::string reason;  ///< who or what asked for it
  std::string model_hash, config_hash;
  std::string config;  ///< what the rows mean: the description of a data set, as YAML
  std::uint64_t seed = 0;
  SessionState state = SessionState::collecting;
  std::int64_t started_ms = 0, ended_ms = 0;
  int steps = 0;
};

struct ResultRecord {
  std::int64_t session = 0, unix_ms = 0;
  ResultAnswer answer = ResultAnswer::failed;
  ResultDecision decision = ResultDecision::none;
  std::string why;
  double p_value = 0, check_before = 0, check_after = 0, endpoint_sigma = 0;
  int touches = 0, rejected = 0, identified = 0;
  std::string json;        ///< result.json; empty for a check
  std::string robot_text;  ///< the calibrated robot; empty for a check
};

enum class Slot : std::uint8_t { active = 0, previous = 1, candidate = 2 };
std::string_view to_string(Slot slot);

struct SlotRecord {
  std::int64_t session = 0;   ///< that it came from; 0 for the factory's parameters
  std::int64_t since_ms = 0;  ///< when it came into this slot
  std::string model_hash, robot_text;
};

struct EventRecord {
  std::int64_t id = 0, unix_ms = 0;
  std::string level;  ///< "info", "warning", "error"
  std::string text;
};

class Store {
 public:
  struct Opened;

  /// Opens or creates the store in `folder` (selfcal.db), migrating an older schema. A damaged one
  /// (SQLite's quick_check) is set aside as selfcal.db.damaged-N with its -wal file and a new one
  /// is begun; `set_aside` says so. A store written by a newer program is a failure and left alone.
  static Result<Opened> open(const std::filesystem::path& folder);
  /// Opens an existing store to read while a service may be writing; functions that write fail.
  static Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& folder);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Begins a session with its whole plan; `session.id` and `.steps` are ignored. Returns the id.
  Result<std::int64_t> begin(const SessionRecord& session, const std::vector<StepRecord>& plan);
  /// Finished and aborted set `ended_ms`, the others clear it.
  Result<void> set_state(std::int64_t session, SessionState state, std::int64_t unix_ms);
  /// The newest session that is `collecting` or `collected`.
  Result<std::optional<SessionRecord>> unfinished();
  Result<std::vector<SessionRecord>> sessions(int newest);  ///< newest first
  Result<SessionRecord> session(std::int64_t id);
  /// As begun; once pruned the steps have no readings, and then there are no steps.
  Result<std::vector<StepRecord>> plan(std::int64_t session);

  /// Fails when the session has ended or its plan has no such step. Counts beyond a sample's
  /// joints are not kept.
  Result<void> add(std::int64_t session, const TouchRecord& touch);
  Result<std::vector<TouchRecord>> touches(std::int64_t session);  ///< in the order they came

  /// Puts the result and ends the session in one transaction. With `candidate`, the robot becomes
  /// the candidate in the same; the decision of one that it takes the place of becomes `replaced`.
  /// A session has one result: a second is a failure.
  Result<void> finish(const ResultRecord& result, const SlotRecord* candidate);
  Result<std::optional<ResultRecord>> result(std::int64_t session);
  Result<std::vector<ResultRecord>> results(int newest);  ///< without json and robot_text

  Result<std::optional<SlotRecord>> slot(Slot slot);
  /// active becomes previous, candidate becomes active, and the session's decision `applied`.
  Result<void> accept(std::int64_t unix_ms);
  /// The candidate is dropped; its session's decision becomes `rejected`.
  Result<void> reject(std::int64_t unix_ms);
  /// active and previous change places (an empty previous is the factory's: active becomes empty).
  /// Fails when there is nothing to go back to.
  Result<void> roll_back(std::int64_t unix_ms);

  Result<void> add(const EventRecord& event);  ///< `id` is ignored
  Result<std::vector<EventRecord>> events(int newest);

  /// A small text kept under a name ("motion_hours"); empty when never set.
  Result<void> remember(const std::string& name, const std::string& text);
  Result<std::string> remembered(const std::string& name);

  /// Deletes the oldest until the content fits `most_bytes`: events first, then the json of results
  /// (the figures stay), then the readings of plans and touches put aside, last the raw rows of
  /// taken touches with the names of their steps; never those of the newest session, of the one
  /// that may be resumed, or of those behind a slot. What cannot go may be more than `most_bytes`.
  Result<void> prune(std::int64_t most_bytes);
  Result<std::int64_t> bytes();  ///< of the content, without free pages and the log

 private:
  explicit Store(sqlite3* database) : database_(database) {}
  sqlite3* database_;
};

struct Store::Opened {
  std::unique_ptr<Store> store;
  std::string set_aside;  ///< what was damaged and where it is now; empty when all was well
};

}  // namespace selfcal
