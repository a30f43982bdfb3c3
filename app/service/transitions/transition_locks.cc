// Configurations with a joint locked: approach → lock ⟲ (visit → settle) → release. The trigger
// closes when the lock is engaged and opens when it is open; a lock that opens by itself is a
// fault. However collecting ends, motion is stopped first and the lock released then.
#include <utility>

#include "app/service/transitions/transition_step.h"

namespace selfcal {

void TransitionStep::lock() {
  s_.out = false;
  s_.engaged = true;
  enter(Phase::lock);
  act(Do::lock);
}

/// Engaged once the robot has said so and the trigger has confirmed it.
void TransitionStep::locked() {
  if (!s_.out || !s_.closed) return;
  s_.felt = true;
  visit();
}

void TransitionStep::visit() {
  enter(Phase::visit);
  act(Do::visit);
}

/// To the next configuration under the same lock, or out of it.
void TransitionStep::visited() {
  if (s_.next_step >= s_.steps || s_.next_lock != s_.lock) return release();
  if (s_.next_step != s_.step) s_.attempt = 0;
  s_.step = s_.next_step;
  visit();
}

void TransitionStep::release() {
  s_.out = false;
  enter(Phase::release);
  act(Do::release);
}

/// Open once the robot has said so and the trigger has confirmed it.
void TransitionStep::released() {
  if (!s_.out || s_.closed) return;
  s_.engaged = false;
  go_on();
}

/// After motion was told to stop: nothing may move with a lock engaged that nobody knows of.
void TransitionStep::let_go() {
  if (std::exchange(s_.engaged, false)) act(Do::release);
}

}  // namespace selfcal
