// What takes too long: every state and phase that waits for something has its limit.
#include "app/service/transitions/transition_step.h"

namespace selfcal {

void TransitionStep::tick() {
  switch (s_.state) {
    case ServiceState::self_test:
      // The test ends by itself at its limit and says what is missing; so this is for none at all.
      return late(limits_.self_test + kSecond, "the self-test");
    case ServiceState::planning:
      return late(limits_.planning, "planning");
    case ServiceState::collecting:
      return tick_collecting();
    case ServiceState::analysing:
    case ServiceState::identifying:
    case ServiceState::judging:
      return late(limits_.computing, std::string(to_string(s_.state)));
    case ServiceState::diagnosing:
      return late(limits_.diagnosing, "diagnosing");
    case ServiceState::fault:
      // Encoders or the robot may be back; a session is resumed by a person only.
      if (longer_than(limits_.retry_self_test)) test();
      return;
    default:
      return;
  }
}

void TransitionStep::tick_collecting() {
  switch (s_.phase) {
    case Phase::approach:
      return late(limits_.approach, "the way to " + touch_name());
    case Phase::touch:
      return late(limits_.touch, touch_name());
    case Phase::settle:
      return late(limits_.settle, "coming to rest after " + touch_name());
    case Phase::retract:
      return late(limits_.retract,
                  s_.closed ? "the trigger is stuck closed: opening after " + touch_name()
                            : "the way out of " + touch_name());
    case Phase::lock:
      return late(limits_.lock, "the lock's confirmation by the trigger for " + touch_name());
    case Phase::visit:
      return late(limits_.approach, "the way to " + touch_name() + " with the lock engaged");
    case Phase::release:
      return late(limits_.lock, "the lock stays closed: its release " + release_name());
    case Phase::none:
      return;
  }
}

void TransitionStep::late(Nanoseconds limit, const std::string& what) {
  if (longer_than(limit))
    fault(what + " took longer than " + std::to_string(limit / kSecond) + " s");
}

}  // namespace selfcal
