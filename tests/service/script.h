// Events handed to the state machine one after another, and what it wants done.
#pragma once

#include <string>

#include "app/service/transitions/transition.h"

namespace selfcal {

inline std::string name_of(Action::Do what) {
  using Do = Action::Do;
  switch (what) {
    case Do::give_up:
      return "give_up";
    case Do::stop:
      return "stop";
    case Do::test:
      return "test";
    case Do::plan:
      return "plan";
    case Do::resume:
      return "resume";
    case Do::go_home:
      return "go_home";
    case Do::go_along:
      return "go_along";
    case Do::go_to_start:
      return "go_to_start";
    case Do::go_nearer:
      return "go_nearer";
    case Do::go_touch:
      return "go_touch";
    case Do::go_back:
      return "go_back";
    case Do::back_off:
      return "back_off";
    case Do::lock:
      return "lock";
    case Do::visit:
      return "visit";
    case Do::release:
      return "release";
    case Do::read:
      return "read";
    case Do::outlier:
      return "put_aside";
    case Do::analyse:
      return "analyse";
    case Do::identify:
      return "identify";
    case Do::judge:
      return "judge";
    case Do::diagnose:
      return "diagnose";
    case Do::apply:
      return "apply";
    case Do::reject:
      return "reject";
    case Do::roll_back:
      return "roll_back";
    case Do::publish:
      return "publish";
    case Do::abort:
      return "abort";
    case Do::grant:
      return "grant";
    case Do::refuse:
      return "refuse";
    case Do::tell:
      return "tell";
  }
  return "?";
}

struct Script {
  ExtendedState s;
  Limits limits;
  Nanoseconds now = 0;
  std::vector<Action> actions;  // of the last event

  Script& on(Event event) {
    event.now = now += kMillisecond;
    Transition transition = step(s, event, limits);
    s = std::move(transition.next);
    actions = std::move(transition.actions);
    return *this;
  }
  Script& on(Event::What what, bool ok = true, const std::string& why = "") {
    Event event;
    event.what = what;
    event.ok = ok;
    event.why = why;
    return on(event);
  }
  Script& ask(Verb verb) {
    Event event;
    event.what = Event::What::commanded;
    event.verb = verb;
    return on(event);
  }
  Script& planned(int steps, SessionKind kind = SessionKind::full, int first = 0,
                  bool via_home = true, bool loaded = false) {
    Event event;
    event.what = Event::What::planned;
    event.session = 7;
    event.kind = kind;
    event.steps = steps;
    event.step = first;
    event.via_home = via_home;
    event.loaded = loaded;
    return on(event);
  }
  /// What the store says after a touch: good or not, and which step comes next.
  Script& read(bool ok, int next, const std::string& why = "") {
    Event event;
    event.what = Event::What::read;
    event.ok = ok;
    event.why = why;
    event.step = next;
    return on(event);
  }
  Script& decided(Event::Decision decision, const std::string& why = "the decision") {
    Event event;
    event.what = Event::What::decided;
    event.decision = decision;
    event.why = why;
    return on(event);
  }
  Script& after(Nanoseconds time) {
    now += time;
    return on(Event::What::tick);
  }

  /// From the approach to the end of the retract; needs `s` in the approach to the step.
  Script& touch_well(int next) {
    while (s.via_home || s.way > 0) on(Event::What::moved);
    on(Event::What::moved);
    on(Event::What::closed).on(Event::What::at_rest);
    read(true, next);
    return on(Event::What::opened).on(Event::What::moved);
  }

  /// What is to be done, in order: "stop, give_up, tell".
  std::string done() const {
    std::string names;
    for (const Action& action : actions)
      names += (names.empty() ? "" : ", ") + name_of(action.what);
    return names;
  }
  /// Why the first action of this kind is to be done.
  std::string why(Action::Do what) const {
    for (const Action& action : actions)
      if (action.what == what) return action.why;
    return "(nothing)";
  }
};

/// A script that has come to `state`, by the way a session goes there.
inline Script script_at(ServiceState state, Phase phase = Phase::approach) {
  using What = Event::What;
  Script script;
  if (state == ServiceState::self_test) return script;
  if (state == ServiceState::fault) return script.on(What::broken, false, "no reading");
  script.on(What::self_tested);
  if (state == ServiceState::idle) return script;
  if (state == ServiceState::diagnosing) return script.ask(Verb::diagnose);
  if (state == ServiceState::awaiting_person)
    return script.ask(Verb::diagnose).planned(5, SessionKind::cause, 0, true, true);
  script.ask(Verb::start);
  if (state == ServiceState::planning) return script;
  script.planned(state == ServiceState::collecting ? 5 : 1);
  if (state == ServiceState::collecting) {
    if (phase == Phase::approach) return script;
    script.on(What::moved).on(What::moved);
    if (phase == Phase::touch) return script;
    script.on(What::closed);
    if (phase == Phase::settle) return script;
    return script.on(What::at_rest).read(true, 1);
  }
  script.touch_well(1);
  if (state == ServiceState::analysing) return script;
  script.on(What::computed);
  if (state == ServiceState::identifying) return script;
  script.on(What::computed);
  if (state == ServiceState::judging) return script;
  if (state == ServiceState::applying) return script.decided(Event::Decision::apply);
  script.decided(state == ServiceState::publishing ? Event::Decision::none : Event::Decision::ask);
  if (state == ServiceState::publishing) return script;
  return script.on(What::published);
}

inline constexpr ServiceState kAllStates[] = {
    ServiceState::self_test,  ServiceState::idle,
    ServiceState::planning,   ServiceState::collecting,
    ServiceState::analysing,  ServiceState::identifying,
    ServiceState::judging,    ServiceState::awaiting_acceptance,
    ServiceState::applying,   ServiceState::publishing,
    ServiceState::diagnosing, ServiceState::awaiting_person,
    ServiceState::fault};
inline constexpr Phase kAllPhases[] = {Phase::approach, Phase::touch, Phase::settle,
                                       Phase::retract};

}  // namespace selfcal
