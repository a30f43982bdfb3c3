#include "app/service/transitions/transition.h"

#include <utility>

#include "app/service/transitions/transition_step.h"

namespace selfcal {

Transition step(const ExtendedState& now, const Event& event, const Limits& limits) {
  return TransitionStep(now, event, limits).run();
}

Transition TransitionStep::run() {
  handle();
  return {std::move(s_), std::move(actions_)};
}

void TransitionStep::handle() {
  using What = Event::What;
  switch (event_.what) {
    case What::tick:
      return tick();
    case What::self_tested:
      return self_tested();
    case What::commanded:
      return commanded();
    case What::due:
      return due();
    case What::planned:
      return planned();
    case What::moved:
      return moved();
    case What::refused:
      return refused();
    case What::closed:
      return closed();
    case What::opened:
      return opened();
    case What::at_rest:
      return at_rest();
    case What::read:
      return read();
    case What::computed:
      return computed();
    case What::decided:
      return decided();
    case What::applied:
      return applied();
    case What::rolled_back:
      return rolled_back();
    case What::published:
      return published();
    case What::broken:
      return fault(event_.why);
  }
}

void TransitionStep::enter(ServiceState state, std::string why) {
  s_.state = state;
  s_.phase = Phase::none;
  s_.postponed = false;
  s_.since = event_.now;
  s_.why = std::move(why);
}

void TransitionStep::enter(Phase phase) {
  s_.phase = phase;
  s_.since = event_.now;
}

void TransitionStep::fault(const std::string& why) {
  if (s_.state == ServiceState::fault) return;
  act(Do::stop, why);
  let_go();
  act(Do::give_up);
  act(Do::tell, "fault: " + why);
  tell_of_load();
  if (in_session()) s_.unfinished = s_.unfinished || s_.stored;
  if (in_session() || s_.follow_up) s_.wanted.reset();
  s_.held = s_.held || s_.tested;  // before the first self-test has passed nothing has moved
  s_.follow_up.reset();            // what was to come by itself does not come after a fault
  enter(ServiceState::fault, why);
}

/// Nothing may begin later with a payload on the tool that nobody knows of.
void TransitionStep::tell_of_load() {
  if (std::exchange(s_.loaded, false))
    act(Do::tell, "the payload is still on the tool: take it off");
}

std::string TransitionStep::touch_name() const {
  return (s_.lock != 0 ? "configuration " : "touch ") + std::to_string(s_.step + 1) + " of " +
         std::to_string(s_.steps);
}

/// A session begins with the release of whatever lock is engaged.
std::string TransitionStep::release_name() const {
  return (s_.engaged ? "after " : "before ") + touch_name();
}

}  // namespace selfcal
