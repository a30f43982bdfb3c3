// The self-test, and how a session begins or goes on.
#include "app/service/transitions/transition_step.h"

namespace selfcal {

void TransitionStep::test() {
  enter(ServiceState::self_test, "testing encoders, trigger and store");
  act(Do::test);
}

void TransitionStep::self_tested() {
  if (s_.state != ServiceState::self_test) return;
  if (!event_.ok) return fault("self-test: " + event_.why);
  const bool goes_on = event_.resume && !s_.held;
  s_.by_itself = true;
  if (goes_on && s_.unfinished) return resume("resumed after a restart");
  s_.tested = true;
  if (goes_on && s_.wanted) {
    act(Do::tell, "begun after a restart: the " + std::string(to_string(*s_.wanted)) +
                      " session that was to begin before it");
    return begin(*s_.wanted, "to begin before a restart");
  }
  if (s_.wanted && !s_.held) {
    const std::string kind(to_string(*s_.wanted));
    s_.wanted.reset();
    return go_idle("the " + kind + " session that was to begin before a restart was not begun");
  }
  go_idle(s_.unfinished ? "an unfinished session can be resumed: start, or abort"
          : s_.held     ? "ready; after a fault or an abort nothing begins by itself before a start"
                        : "ready");
}

void TransitionStep::go_idle(std::string why) {
  if (s_.candidate)
    enter(ServiceState::awaiting_acceptance, "a result waits: accept or reject");
  else
    enter(ServiceState::idle, std::move(why));
}

void TransitionStep::due() {
  if (s_.state != ServiceState::idle || s_.held) return;
  s_.by_itself = true;
  if (s_.unfinished) return resume("due: " + event_.why);
  begin(event_.kind, event_.why);
}

void TransitionStep::begin(SessionKind kind, const std::string& why) {
  s_.kind = kind;
  s_.wanted = kind;
  s_.stored = false;
  if (kind == SessionKind::cause) return diagnose(why);
  enter(ServiceState::planning, why);
  act(Do::plan, why);
}

void TransitionStep::resume(const std::string& why) {
  enter(ServiceState::planning, why);
  s_.tested = true;
  act(Do::tell, why);
  act(Do::resume);
}

/// Nobody waits for it: the robot ends its work first.
void TransitionStep::postpone() {
  s_.unfinished = s_.unfinished || s_.stored;
  s_.wanted.reset();
  act(Do::tell, "postponed: " + event_.why);
  go_idle("postponed until the robot stands: " + event_.why);
  s_.postponed = s_.unfinished;
}

bool TransitionStep::in_session() const {
  switch (s_.state) {
    case ServiceState::planning:
    case ServiceState::collecting:
    case ServiceState::analysing:
    case ServiceState::identifying:
    case ServiceState::judging:
    case ServiceState::diagnosing:
    case ServiceState::awaiting_person:
      return true;
    default:
      return false;
  }
}

}  // namespace selfcal
