// From the touches to the decision: analysing → identifying → judging → applying → publishing.
#include <utility>

#include "app/service/transitions/transition_step.h"

namespace selfcal {

void TransitionStep::analyse() {
  enter(ServiceState::analysing, "all is collected");
  act(Do::analyse);
}

void TransitionStep::computed() {
  const bool failed = s_.state == ServiceState::diagnosing && !event_.ok;
  if (s_.state != ServiceState::analysing && s_.state != ServiceState::identifying && !failed)
    return;
  if (!event_.ok) {
    fault(event_.why);
    act(Do::abort, event_.why);
    s_.unfinished = s_.stored = false;
    return;
  }
  if (s_.kind == SessionKind::cause) return diagnose("looking for the cause");
  if (s_.state == ServiceState::analysing && s_.kind == SessionKind::full) {
    enter(ServiceState::identifying, "identifying the parameters");
    return act(Do::identify);
  }
  if (event_.more) {
    enter(ServiceState::planning, event_.why);
    return act(Do::plan, s_.why);
  }
  enter(ServiceState::judging, "judging on the rows kept aside");
  act(Do::judge);
}

void TransitionStep::diagnose(std::string why) {
  enter(ServiceState::diagnosing, std::move(why));
  act(Do::diagnose, s_.why);
}

void TransitionStep::decided() {
  if (s_.state != ServiceState::judging && s_.state != ServiceState::diagnosing) return;
  s_.stored = false;
  if (event_.session > 0) s_.session = event_.session;
  if (event_.cause) {
    s_.follow_up = SessionKind::cause;
    s_.follow_up_why = "calibration leaves more than noise";
  }
  if (event_.decision == Event::Decision::full) {
    s_.follow_up = SessionKind::full;
    s_.follow_up_why = "the quick check was not explained";
  }
  s_.wanted = s_.follow_up;
  switch (event_.decision) {
    case Event::Decision::apply:
      s_.candidate = false;
      enter(ServiceState::applying, event_.why);
      return act(Do::apply, event_.why);
    case Event::Decision::ask:
      s_.candidate = true;
      break;
    case Event::Decision::full:
    case Event::Decision::none:
      break;
  }
  s_.why = event_.why;
  publish();
}

void TransitionStep::applied() {
  if (s_.state == ServiceState::applying) publish();
}

void TransitionStep::publish() {
  enter(ServiceState::publishing, std::move(s_.why));
  act(Do::publish);
}

void TransitionStep::published() {
  if (s_.state != ServiceState::publishing) return;
  ++s_.published;
  if (const auto next = std::exchange(s_.follow_up, std::nullopt)) {
    s_.by_itself = true;
    return begin(*next, std::exchange(s_.follow_up_why, {}));
  }
  go_idle(s_.why);
}

}  // namespace selfcal
