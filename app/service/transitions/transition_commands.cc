// What a person asks for: granted and done, or refused with the reason.
#include "app/service/transitions/transition_step.h"

namespace selfcal {
namespace {

constexpr const char* kResultWaits = "a result waits for acceptance: accept or reject it first";
constexpr const char* kNoResultWaits = "no result waits for acceptance";

}  // namespace

void TransitionStep::commanded() {
  switch (event_.verb) {
    case Verb::start:
      return commanded_to_start(SessionKind::full);
    case Verb::check:
      return commanded_to_start(SessionKind::check);
    case Verb::diagnose:
      return commanded_to_start(SessionKind::cause);
    case Verb::done:
      return told_done();
    case Verb::abort:
      return commanded_to_abort();
    case Verb::accept:
      return commanded_to_accept();
    case Verb::reject:
      return commanded_to_reject();
    case Verb::rollback:
      return commanded_to_roll_back();
  }
}

void TransitionStep::commanded_to_start(SessionKind kind) {
  if (s_.state == ServiceState::fault) {
    s_.held = false;
    act(Do::grant, "testing first; what is unfinished goes on with another start");
    return test();
  }
  if (s_.state == ServiceState::awaiting_acceptance) return refuse(kResultWaits);
  if (s_.state != ServiceState::idle) return refuse_in_this_state();
  if (kind != SessionKind::full && s_.unfinished)
    return refuse("an unfinished session waits: start or abort it first");
  s_.held = s_.by_itself = false;
  grant();
  if (s_.unfinished) return resume("resumed by command");
  begin(kind, "by command");
}

void TransitionStep::told_done() {
  if (s_.state != ServiceState::awaiting_person)
    return refuse("nothing is waited for that a person does");
  if (s_.closed && s_.step < s_.steps)
    return refuse("the trigger is closed: open it first, then say done again");
  grant();
  s_.loaded = s_.next_loaded;
  enter(ServiceState::collecting, "goes on after the payload was changed");
  s_.next_via_home = true;  // wherever it was moved meanwhile
  go_on_loaded();
}

void TransitionStep::commanded_to_abort() {
  const bool running = in_session();
  if (!running && !s_.unfinished) return refuse("no session is running");
  if (s_.state == ServiceState::applying || s_.state == ServiceState::publishing)
    return refuse_in_this_state();
  grant();
  act(Do::stop, "aborted by command");
  let_go();
  tell_of_load();
  act(Do::abort, "aborted by command");
  s_.unfinished = false;
  s_.wanted.reset();
  s_.held = true;
  if (running || s_.state == ServiceState::idle)
    go_idle("aborted by command; what was collected is kept");
}

/// One that waits is not decided on while its cause is looked for, or before a fault is mended.
void TransitionStep::refuse_without_result() {
  if (s_.candidate) return refuse_in_this_state();
  refuse(kNoResultWaits);
}

void TransitionStep::commanded_to_accept() {
  if (s_.state != ServiceState::awaiting_acceptance) return refuse_without_result();
  s_.candidate = false;
  enter(ServiceState::applying, "accepted by command");
  act(Do::apply, "accepted by command");  // answers the command, as a rollback does
}

void TransitionStep::commanded_to_reject() {
  if (s_.state != ServiceState::awaiting_acceptance) return refuse_without_result();
  s_.candidate = false;
  act(Do::reject, "rejected by command");  // answers the command
  s_.why = "rejected by command";
  publish();
}

void TransitionStep::commanded_to_roll_back() {
  if (s_.candidate) return refuse(kResultWaits);
  if (s_.state != ServiceState::idle && s_.state != ServiceState::fault)
    return refuse_in_this_state();
  act(Do::roll_back);  // answers the command: the store knows whether there is something
}

/// What led to the parameters that are given up is no reason any more; that of a fault is.
void TransitionStep::rolled_back() {
  if (s_.state == ServiceState::idle) s_.why = event_.why;
}

}  // namespace selfcal
