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
//
// Every row has a checksum (checksums.h), which every function that reads it verifies. A row whose
// checksum does not hold is never returned as what it says: a function of one row fails, lists say
// below what they do; `met` has its name. Calls must come one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
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
  bool slow = false;                      ///< touched at a third of the usual speed
  bool loaded = false;                    ///< with the payload on the tool
  bool via_home = false;                  ///< travel there through the home configuration
  std::vector<std::vector<double>> way;   ///< readings to travel through else
  std::vector<double> start, touch, end;  ///< readings: free, nominal contact, farthest (rad or m)
};

enum class TouchOutcome : std::uint8_t {
  taken = 0,
  outlier = 1,
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
  std::string kind;    ///< "full", "check" or "cause"
  std::string reason;  ///< who or what asked for it
  std::string model_hash, config_hash;
  std::string config;  ///< what the rows mean: the description of a data set, as YAML
  std::uint64_t seed = 0;
  SessionState state = SessionState::collecting;
  std::int64_t started_ms = 0, ended_ms = 0;
  int steps = 0;
};

struct ResultRecord : ResultFigures {
  std::int64_t session = 0, unix_ms = 0;
  ResultAnswer answer = ResultAnswer::failed;
  ResultDecision decision = ResultDecision::none;
  std::string why;
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

/// A small text under a name.
struct Remembered {
  std::string name = {}, text = {};
};

/// Something that was found damaged, and is not used any more.
struct DamageRecord {
  std::int64_t unix_ms = 0;  ///< when it was found
  std::string place;         ///< active, previous, candidate, store, or the table
  std::string what;          ///< as a person calls it
  std::string row;           ///< of a row that left its table: its columns; else empty
};

namespace sqlite {
class Statement;
class Transaction;
}  // namespace sqlite
class StoreMark;

class Store {
 public:
  struct Opened;

  /// Opens or creates the store in `folder` (selfcal.db), migrating an older schema. One whose
  /// pages are damaged (SQLite's integrity_check) is set aside as selfcal.db.damaged-N with its
  /// -wal file, and a new one is begun with the rows of it that can be read; one that is gone or of
  /// 0 bytes, too. Then every row is looked at: damaged slots are set aside (the previous
  /// parameters take the place of damaged active ones), unfinished sessions that cannot go on are
  /// ended. `set_aside` says all of it, `damage` has it noted. A store written by a newer program
  /// is a failure and left alone.
  static Result<Opened> open(const std::filesystem::path& folder);
  /// Opens an existing store to read while a service may be writing; functions that write fail. It,
  /// too, looks at every page and row, and `met` has what is damaged.
  static Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path& folder);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Begins a session with its whole plan; `session.id` and `.steps` are ignored. Those that are
  /// unfinished are aborted with it. Returns the id.
  Result<std::int64_t> begin(const SessionRecord& session, const std::vector<StepRecord>& plan);
  /// Appends steps to the plan of a session that has not ended, which is collecting then. The
  /// session has all of its steps with their readings.
  Result<void> extend(std::int64_t session, const std::vector<StepRecord>& steps);
  /// Finished and aborted set `ended_ms`, the others clear it.
  Result<void> set_state(std::int64_t session, SessionState state, std::int64_t unix_ms);
  /// The newest session that is `collecting` or `collected`.
  Result<std::optional<SessionRecord>> unfinished();
  /// Newest first. A damaged one has its number, the reason that it is damaged, and nothing else.
  Result<std::vector<SessionRecord>> sessions(int newest);
  Result<SessionRecord> session(std::int64_t id);
  /// As begun; once pruned the steps have no readings, and then there are no steps.
  Result<std::vector<StepRecord>> plan(std::int64_t session);

  /// Fails when the session has ended or its plan has no such step. Counts beyond a sample's
  /// joints are not kept.
  Result<void> add(std::int64_t session, const TouchRecord& touch);
  /// In the order they came, without damaged ones.
  Result<std::vector<TouchRecord>> touches(std::int64_t session);

  /// Puts the result and ends the session in one transaction. With `candidate`, the robot becomes
  /// the candidate in the same; the decision of one that it takes the place of becomes `replaced`.
  /// `kept` is remembered in the same, unless it has no name. A session has one result: a second is
  /// a failure.
  Result<void> finish(const ResultRecord& result, const SlotRecord* candidate,
                      const Remembered& kept = {});
  /// A damaged json or robot_text is empty.
  Result<std::optional<ResultRecord>> result(std::int64_t session);
  /// Without json and robot_text, and without damaged ones.
  Result<std::vector<ResultRecord>> results(int newest);

  Result<std::optional<SlotRecord>> slot(Slot slot);
  /// active becomes previous, candidate becomes active, and the session's decision `applied`. Fails
  /// on a damaged candidate; damaged active ones are set aside and leave previous as it is.
  Result<void> accept(std::int64_t unix_ms);
  /// The candidate is dropped; its session's decision becomes `rejected`.
  Result<void> reject(std::int64_t unix_ms);
  /// One step back: active is given up and its session's decision becomes `rolled_back`, previous
  /// becomes active (an empty previous is the factory's: active becomes empty). What was rolled
  /// back never comes back by another step. Fails when the factory's are active.
  Result<void> roll_back(std::int64_t unix_ms);

  Result<void> add(const EventRecord& event);  ///< `id` is ignored
  /// Newest first. A damaged one has its id and says that it is damaged.
  Result<std::vector<EventRecord>> events(int newest);

  /// A small text kept under a name ("motion_hours"); empty when never set.
  Result<void> remember(const std::string& name, const std::string& text);
  Result<std::string> remembered(const std::string& name);

  /// What was found damaged whenever the store was opened, or slots were changed; newest first.
  Result<std::vector<DamageRecord>> damage();
  /// What was found damaged and had not been noted, each once: by reading, and where the store was
  /// opened to read.
  const std::vector<std::string>& met() const { return met_; }

  /// Its file was renamed or deleted since: what it reads is not what the folder has now.
  bool moved() const;

  /// Deletes the oldest until the content fits `most_bytes`: events first, then the json of results
  /// (the figures stay), then the readings of plans and touches put aside, last the raw rows of
  /// taken touches with the names of their steps; never those of the newest session, of the one
  /// that may be resumed, or of those behind a slot. What cannot go may be more than `most_bytes`.
  Result<void> prune(std::int64_t most_bytes);
  Result<std::int64_t> bytes();  ///< of the content, without free pages and the log

 private:
  Store(sqlite3* database, std::unique_ptr<StoreMark> mark);
  /// Ends a change: it counts, in the store and in the mark beside it.
  Result<void> commit(sqlite::Transaction& change);
  void meet(const std::string& what);
  /// Whether the column says nothing (SELFCAL_DAMAGED_…); what it says is met.
  bool sound(const sqlite::Statement& row, int column);
  SessionRecord session_of(const sqlite::Statement& row);
  ResultRecord figures_of(const sqlite::Statement& row);

  sqlite3* database_;
  std::unique_ptr<StoreMark> mark_;  ///< none where it was opened to read
  std::set<std::string> known_;      ///< damage that was told of
  std::vector<std::string> met_;
};

struct Store::Opened {
  std::unique_ptr<Store> store;
  std::string set_aside;  ///< what was damaged and what became of it; empty when all was well
};

}  // namespace selfcal
