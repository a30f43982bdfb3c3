// Touch by touch: approach → touch → settle → retract, and the contacts that were not looked for.
#include <utility>

#include "app/service/transitions/transition_step.h"

namespace selfcal {

void TransitionStep::planned() {
  if (s_.state != ServiceState::planning && s_.state != ServiceState::diagnosing) return;
  if (event_.session > 0) {
    s_.stored = true;
    s_.session = event_.session;
  }
  if (event_.ended) s_.unfinished = s_.stored = false;
  if (!event_.ok) return event_.later && s_.by_itself ? postpone() : fault(event_.why);
  s_.stored = true;
  s_.wanted.reset();
  s_.session = event_.session;
  s_.kind = event_.kind;
  s_.step = event_.step;
  s_.lock = s_.next_lock = event_.lock;
  s_.steps = event_.steps;
  s_.lost_in_a_row = 0;
  s_.unfinished = false;
  s_.next_loaded = event_.loaded;
  if (event_.load_unknown) s_.loaded = !event_.loaded;
  if (s_.step >= s_.steps && s_.loaded == event_.loaded) return analyse();
  if (s_.closed && event_.via_home && !event_.back_off && !event_.release)
    return fault("the trigger is closed away from any touch: move the robot out by hand");
  enter(ServiceState::collecting, s_.why);
  s_.felt = false;
  s_.next_step = s_.step;
  s_.next_via_home = event_.via_home;
  s_.next_way = event_.way;
  s_.next_nearer = event_.nearer;
  if (event_.release) return release();
  // Nobody changes the payload of a robot that stands in a contact.
  const bool touching = s_.closed && s_.step < s_.steps && s_.loaded != s_.next_loaded;
  if (!event_.back_off && !touching) return go_on_loaded();
  s_.attempt = s_.failures = 0;
  s_.stray = true;
  back_off();
}

void TransitionStep::approach() {
  s_.attempt = s_.failures = 0;
  s_.stray = false;
  s_.next_step = s_.step;
  s_.via_home = s_.next_via_home;
  s_.way = s_.via_home ? 0 : s_.next_way;
  s_.nearer = s_.next_nearer;
  come();
}

/// Through home or along the way that was planned, then to the start.
void TransitionStep::come() {
  enter(Phase::approach);
  act(s_.via_home ? Do::go_home : s_.way > 0 ? Do::go_along : Do::go_to_start);
}

/// Straight in from the start: at first a stretch that is known to be free, where there is one.
void TransitionStep::come_in() {
  if (!std::exchange(s_.nearer, false)) return touch();
  enter(Phase::approach);
  act(Do::go_nearer);
}

void TransitionStep::touch() {
  s_.stray = false;
  enter(Phase::touch);
  act(Do::go_touch);
}

void TransitionStep::closed() {
  s_.closed = true;
  if (s_.state != ServiceState::collecting) return;
  if (s_.phase == Phase::lock) return locked();
  if (s_.phase == Phase::touch) {
    s_.felt = true;
    act(Do::stop, "touched");
    enter(Phase::settle);
  } else if (s_.phase == Phase::approach) {
    act(Do::stop, "the trigger closed on the way");
    s_.stray = true;
    enter(Phase::settle);
  }
}

void TransitionStep::opened() {
  s_.closed = false;
  if (s_.phase == Phase::release) return released();
  if (s_.engaged && (s_.phase == Phase::visit || s_.phase == Phase::settle))
    return fault("the lock opened by itself at " + touch_name());
  back_out();
}

void TransitionStep::moved() {
  if (s_.state != ServiceState::collecting) return;
  if (s_.phase == Phase::approach && s_.closed)
    return fault("the trigger is closed before " + touch_name() + ": it is stuck");
  if (s_.phase == Phase::approach && (s_.via_home || s_.way > 0)) {
    if (!std::exchange(s_.via_home, false)) --s_.way;
    return come();
  }
  if (s_.phase == Phase::approach) return s_.lock != 0 ? lock() : come_in();
  if (s_.phase == Phase::touch) return act(Do::outlier, "no touch up to the end of the search");
  if (s_.phase == Phase::visit) return enter(Phase::settle);
  s_.out = true;
  if (s_.phase == Phase::lock) return locked();
  if (s_.phase == Phase::release) return released();
  back_out();
}

void TransitionStep::at_rest() {
  if (s_.state != ServiceState::collecting || s_.phase != Phase::settle) return;
  if (!s_.stray) return act(Do::read);
  act(Do::tell, "the trigger closed on the way to " + touch_name());
  back_off();
}

/// To where the last move began.
void TransitionStep::back_off() {
  s_.out = false;
  enter(Phase::retract);
  act(Do::back_off);
}

/// Out of the contact once the retract has ended and the trigger is open.
void TransitionStep::back_out() {
  if (s_.state != ServiceState::collecting || s_.phase != Phase::retract || !s_.out) return;
  if (s_.closed) return;  // the time limit tells when it is stuck
  if (s_.stray) return backed_off();
  if (s_.next_step != s_.step) return go_on();
  s_.nearer = s_.next_nearer;
  come_in();
}

/// To the next step, from where nothing is touched and nothing locked.
void TransitionStep::go_on() {
  s_.step = s_.next_step;
  s_.lock = s_.next_lock;
  go_on_loaded();
}

/// With the payload that the step wants; without any after the last one.
void TransitionStep::go_on_loaded() {
  if (s_.loaded != s_.next_loaded) return ask_for_load();
  if (s_.step >= s_.steps) return analyse();
  approach();
}

void TransitionStep::ask_for_load() {
  enter(ServiceState::awaiting_person,
        std::string(s_.next_loaded ? "hang the payload on the tool"
                                   : "take the payload off the tool") +
            ", then say done (selfcal command done)");
  act(Do::tell, s_.why);
}

/// Out of a contact that was not looked for.
void TransitionStep::backed_off() {
  s_.stray = false;
  if (++s_.failures >= limits_.attempts)
    return fault("the trigger closes again and again on the way to " + touch_name() +
                 ": something stands in the way");
  if (s_.loaded != s_.next_loaded) return go_on_loaded();
  s_.via_home = true;
  s_.way = 0;
  s_.nearer = false;
  come();
}

void TransitionStep::read() {
  if (s_.state != ServiceState::collecting) return;
  ++s_.attempt;
  s_.next_step = event_.step;
  s_.next_via_home = event_.via_home;
  s_.next_way = event_.way;
  s_.next_nearer = event_.nearer;
  s_.next_lock = event_.lock;
  s_.next_loaded = event_.loaded;
  s_.out = false;
  if (event_.ok)
    s_.lost_in_a_row = 0;
  else if (s_.next_step != s_.step && !s_.felt)
    return fault("no touch has been felt: is the probe connected? The first: " + event_.why);
  else if (s_.next_step != s_.step && ++s_.lost_in_a_row >= limits_.most_failures)
    return fault(std::to_string(s_.lost_in_a_row) +
                 " touches in a row gave nothing; the last: " + event_.why);
  if (s_.engaged) return visited();
  enter(Phase::retract);
  act(Do::go_back);
}

void TransitionStep::refused() {
  if (s_.state != ServiceState::collecting) return;
  const std::string what = s_.phase == Phase::lock      ? "the lock for "
                           : s_.phase == Phase::release ? "the lock's release "
                                                        : "motion to ";
  fault(what + (s_.phase == Phase::release ? release_name() : touch_name()) +
        " was refused: " + event_.why);
}

}  // namespace selfcal
