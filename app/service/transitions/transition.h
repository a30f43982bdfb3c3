// The service's behaviour as a pure function: state and event to the next state and what is
// to be done. It reads no clock, no port and no file; every moment comes in with the event.
//
//   self-test → idle → planning → collecting ⟲ (approach → touch → settle → retract)
//     or of a lock: approach → lock ⟲ (visit → settle) → release
//     → analysing → identifying → judging → awaiting acceptance → applying → publishing → idle
//   by rounds: planning ⟲ (collecting → analysing → identifying) until enough is known
//   looking for a cause: idle → diagnosing ⟲ (collecting → analysing) → as after judging, with
//   awaiting person while the payload is changed between two touches
//   and from everywhere: fault, which stops motion and keeps what was collected.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/service/transitions/state.h"
#include "io/ports.h"

namespace selfcal {

/// How long each part may take and how much may go wrong.
struct Limits {
  Nanoseconds self_test = 10 * kSecond;
  Nanoseconds planning = 120 * kSecond;
  Nanoseconds approach = 60 * kSecond;
  Nanoseconds touch = 60 * kSecond;
  Nanoseconds settle = 2 * kSecond;
  Nanoseconds retract = 30 * kSecond;
  Nanoseconds lock = 30 * kSecond;        ///< a lock's engaging, or its release
  Nanoseconds computing = 600 * kSecond;  ///< analysing, identifying, judging
  Nanoseconds diagnosing = 1800 * kSecond;
  Nanoseconds retry_self_test = 10 * kSecond;
  int attempts = 3;       ///< of one touch, before it is put aside
  int most_failures = 5;  ///< touches put aside in a row, before the session stops
};

/// The state, and what its transitions depend on beside it.
struct ExtendedState {
  ServiceState state = ServiceState::self_test;
  Phase phase = Phase::none;
  Nanoseconds since = 0;  ///< state or phase entered
  std::string why;        ///< why it is in this state
  std::int64_t session = 0;
  SessionKind kind = SessionKind::full;
  int step = 0, steps = 0;     ///< the touch in progress; planned ones
  int attempt = 0;             ///< of this step, from 0
  int failures = 0;            ///< stray closings on the way to this step
  int lost_in_a_row = 0;       ///< steps put aside one after another
  bool via_home = false;       ///< on the way to home, not yet to the start
  int way = 0;                 ///< places of the step's way that are still ahead, before the start
  bool nearer = false;         ///< from the start on there is a stretch before the slow one
  bool stray = false;          ///< the trigger closed where nothing was to be touched
  int next_step = 0;           ///< after the retract; `step` itself when it needs another touch
  bool next_via_home = false;  ///< of the step after this one
  int next_way = 0;            ///< as well
  bool next_nearer = false;    ///< as well
  bool out = false;            ///< what was asked has ended; the trigger may not have followed
  int lock = 0;                ///< that the step wants engaged; 0 for none
  int next_lock = 0;           ///< of the step after this one
  bool loaded = false;         ///< the payload is on the tool
  bool next_loaded = false;    ///< of the step after this one
  bool engaged = false;        ///< a lock was asked for and has not been released
  std::optional<SessionKind> follow_up;  ///< comes after what is being published
  std::string follow_up_why;
  bool closed = false;      ///< the trigger's debounced level
  bool candidate = false;   ///< a result waits for a person
  bool unfinished = false;  ///< a session can be resumed by `start`
  bool by_itself = false;   ///< nobody has asked for the session in progress
  bool postponed = false;   ///< idle: the unfinished one goes on once the robot stands
  bool stored = false;      ///< the session in progress is in the store
  /// Granted or due, and not in the store yet: a restart begins it.
  std::optional<SessionKind> wanted;
  int published = 0;    ///< results since the start
  bool tested = false;  ///< the self-test has been passed since the start
  bool held = false;    ///< after a fault or an abort: nothing moves until a person says start
  bool felt = false;    ///< a touch has been felt in this run of the session
};

struct Event {
  enum class What : std::uint8_t {
    tick,         ///< time has passed
    self_tested,  ///< ok or not, `why`; `resume` when a session shall go on by itself
    commanded,    ///< `verb`
    due,          ///< `kind`, `why`
    planned,      ///< `session`, `steps`, `step` to begin with, or further steps of it; or not ok,
                  ///< with a `session` that is in the store by then
    moved,        ///< the last motion has ended as asked
    refused,      ///< the last motion was refused or stopped by others, `why`
    closed,       ///< the trigger closed, debounced
    opened,
    at_rest,   ///< joints stand, and the samples around the edge are there
    read,      ///< the touch was judged and is stored: `ok` or put aside; then comes `step`
    computed,  ///< the stage in progress has ended; `ok`, `why`
    decided,   ///< after judging or diagnosing: `decision`; `cause` when one is to be looked for
    applied,
    rolled_back,  ///< `why`
    published,
    broken,  ///< a port or the store has failed: `why`
  };
  enum class Decision : std::uint8_t { none, ask, apply, full };
  What what = What::tick;
  Nanoseconds now = 0;
  bool ok = true, resume = false;
  bool back_off = false;  ///< of `planned`: out of the contact in which the robot stands, first
  std::string why;
  Verb verb = Verb::start;
  SessionKind kind = SessionKind::full;
  std::int64_t session = 0;
  int step = 0, steps = 0;
  bool via_home = false;  ///< of the step that comes next
  int way = 0;            ///< as well: places that the way leads through
  bool nearer = false;    ///< as well: it becomes slow nearer to the surface than the start is
  int lock = 0;           ///< of the step that comes next
  bool loaded = false;    ///< as well
  bool load_unknown =
      false;             ///< of `planned`: an earlier life may have left the payload on the tool
  bool later = false;    ///< of `planned` that is not ok: it may be, once the robot stands
  bool ended = false;    ///< of `planned` that is not ok: nothing is left that could be resumed
  bool release = false;  ///< of `planned`: whatever lock may be engaged, first
  Decision decision = Decision::none;
  bool cause = false;  ///< of `decided`: more than noise is left
  bool more = false;   ///< of `computed`, once identified: further touches are to be planned
};

struct Action {
  enum class Do : std::uint8_t {
    stop,     ///< motion, now; `why`
    give_up,  ///< whatever is being computed
    test,     ///< begin the self-test
    plan,     ///< a session of the state's kind, full or check, or a further round of it
    resume,   ///< the unfinished session
    go_home,
    go_along,  ///< to the next place of the step's way
    go_to_start,
    go_nearer,  ///< straight in, to where it becomes slow
    go_touch,
    go_back,   ///< motion for the step in progress
    lock,      ///< engage the lock of the step in progress
    visit,     ///< to the step in progress with the lock engaged
    release,   ///< open whatever lock is engaged
    back_off,  ///< to where the last move began, out of a contact that was not looked for
    read,      ///< judge and store the touch whose edge was seen
    outlier,   ///< store the attempt as failed; `why`
    analyse,
    identify,
    judge,
    diagnose,   ///< what the rows say of the cause, and what to touch next
    apply,      ///< and answer the command, where one has asked for it
    reject,     ///< as well
    roll_back,  ///< as well
    publish,
    abort,  ///< the session ends early; what was collected is kept
    grant,
    refuse,  ///< answer to the command; `why`
    tell,    ///< an event worth keeping; `why`
  };
  Do what;
  std::string why;
};

struct Transition {
  ExtendedState next;
  std::vector<Action> actions;
};

Transition step(const ExtendedState& now, const Event& event, const Limits& limits);

}  // namespace selfcal
