// From the touches to the decision: analysing → identifying → judging → applying → publishing.
#include <utility>

#include "app/service/transition_step.h"

namespace selfcal {

void TransitionStep::analyse() {
  enter(ServiceState::analysing, "all is collected");
  act(Do::analyse);
}

void TransitionStep::computed() {
  if (s_.state != ServiceState::analysing && s_.state != ServiceState::identifying) return;
  if (!event_.ok) {
    fault(event_.why);
    act(Do::abort, event_.why);
    s_.unfinished = false;
    return;
  }
  if (s_.state == ServiceState::analysing && s_.kind == SessionKind::full) {
    enter(ServiceState::identifying, "identifying the parameters");
    return act(Do::identify);
  }
  enter(ServiceState::judging, "judging on the rows kept aside");
  act(Do::judge);
}

void TransitionStep::decided() {
  if (s_.state != ServiceState::judging) return;
  switch (event_.decision) {
    case Event::Decision::apply:
      enter(ServiceState::applying, event_.why);
      return act(Do::apply, event_.why);
    case Event::Decision::ask:
      s_.candidate = true;
      break;
    case Event::Decision::full:
      s_.follow_up = true;
      break;
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
  if (std::exchange(s_.follow_up, false))
    return begin(SessionKind::full, "the quick check was not explained");
  go_idle(s_.why);
}

}  // namespace selfcal
