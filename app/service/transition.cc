#include "app/service/transition.h"

#include <utility>

namespace selfcal {
namespace {

using Do = Action::Do;
using What = Event::What;

/// One transition in the making.
class Step {
 public:
  Step(const Situation& now, const Event& event, const Limits& limits)
      : s_(now), event_(event), limits_(limits) {}

  Transition run() {
    switch (event_.what) {
      case What::asked:
        asked();
        break;
      case What::broken:
        fault(event_.why);
        break;
      case What::closed:
        closed();
        break;
      case What::opened:
        s_.closed = false;
        back_out();
        break;
      case What::tick:
        tick();
        break;
      case What::self_tested:
        self_tested();
        break;
      case What::due:
        due();
        break;
      case What::planned:
        planned();
        break;
      case What::moved:
        moved();
        break;
      case What::refused:
        refused();
        break;
      case What::at_rest:
        at_rest();
        break;
      case What::read:
        read();
        break;
      case What::computed:
        computed();
        break;
      case What::decided:
        decided();
        break;
      case What::applied:
        if (s_.state == ServiceState::applying) publish();
        break;
      case What::published:
        published();
        break;
    }
    return {std::move(s_), std::move(actions_)};
  }

 private:
  void act(Do what, std::string why = {}) { actions_.push_back({what, std::move(why)}); }

  void enter(ServiceState state, std::string why) {
    s_.state = state;
    s_.phase = Phase::none;
    s_.since = event_.now;
    s_.why = std::move(why);
  }

  void enter(Phase phase) {
    s_.phase = phase;
    s_.since = event_.now;
  }

  std::string touch_name() const {
    return "touch " + std::to_string(s_.step + 1) + " of " + std::to_string(s_.steps);
  }

  void fault(const std::string& why) {
    if (s_.state == ServiceState::fault) return;
    act(Do::stop, why);
    act(Do::give_up);
    act(Do::tell, "fault: " + why);
    if (s_.state == ServiceState::collecting || s_.state == ServiceState::analysing ||
        s_.state == ServiceState::identifying || s_.state == ServiceState::judging)
      s_.unfinished = true;
    s_.held = s_.held || s_.tested;  // before the first self-test has passed nothing has moved
    s_.follow_up = false;            // what was to come by itself does not come after a fault
    enter(ServiceState::fault, why);
  }

  // ------------------------------------------------------------------------- at rest

  void test() {
    enter(ServiceState::self_test, "testing encoders, trigger and store");
    act(Do::test);
  }

  void self_tested() {
    if (s_.state != ServiceState::self_test) return;
    if (!event_.ok) return fault("self-test: " + event_.why);
    if (event_.resume && s_.unfinished && !s_.held) return resume("resumed after a restart");
    s_.tested = true;
    go_idle(s_.unfinished ? "an unfinished session can be resumed: start, or abort"
            : s_.held ? "ready; after a fault or an abort nothing begins by itself before a start"
                      : "ready");
  }

  void go_idle(std::string why) {
    if (s_.candidate)
      enter(ServiceState::awaiting_acceptance, "a result waits: accept or reject");
    else
      enter(ServiceState::idle, std::move(why));
  }

  void resume(const std::string& why) {
    enter(ServiceState::planning, why);
    s_.tested = true;
    act(Do::tell, why);
    act(Do::resume);
  }

  void begin(SessionKind kind, const std::string& why) {
    s_.kind = kind;
    enter(ServiceState::planning, why);
    act(Do::plan, why);
  }

  void due() {
    if (s_.state != ServiceState::idle || s_.held) return;
    if (s_.unfinished) return resume("due: " + event_.why);
    begin(event_.kind, event_.why);
  }

  // ------------------------------------------------------------------------ commands

  void grant() { act(Do::grant, std::string(to_string(event_.verb))); }
  void refuse(const std::string& why) { act(Do::refuse, why); }

  void asked() {
    switch (event_.verb) {
      case Verb::start:
        return asked_to_start(SessionKind::full);
      case Verb::check:
        return asked_to_start(SessionKind::check);
      case Verb::abort:
        return asked_to_abort();
      case Verb::accept:
        return asked_to_accept(true);
      case Verb::reject:
        return asked_to_accept(false);
      case Verb::rollback:
        return asked_to_roll_back();
    }
  }

  void asked_to_start(SessionKind kind) {
    if (s_.state == ServiceState::fault) {
      s_.held = false;
      act(Do::grant, "testing first; what is unfinished goes on with another start");
      return test();
    }
    if (s_.state == ServiceState::awaiting_acceptance)
      return refuse("a result waits for acceptance: accept or reject it first");
    if (s_.state != ServiceState::idle)
      return refuse("the service is " + std::string(to_string(s_.state)));
    if (kind == SessionKind::check && s_.unfinished)
      return refuse("an unfinished session waits: start or abort it first");
    s_.held = false;
    grant();
    if (s_.unfinished) return resume("resumed by command");
    begin(kind, "by command");
  }

  void asked_to_abort() {
    const bool running = s_.state == ServiceState::planning ||
                         s_.state == ServiceState::collecting ||
                         s_.state == ServiceState::analysing ||
                         s_.state == ServiceState::identifying || s_.state == ServiceState::judging;
    if (!running && !s_.unfinished) return refuse("no session is running");
    if (s_.state == ServiceState::applying || s_.state == ServiceState::publishing)
      return refuse("the service is " + std::string(to_string(s_.state)));
    grant();
    act(Do::stop, "aborted by command");
    act(Do::abort, "aborted by command");
    s_.unfinished = false;
    s_.held = true;
    if (running || s_.state == ServiceState::idle)
      go_idle("aborted by command; what was collected is kept");
  }

  void asked_to_accept(bool accept) {
    if (s_.state != ServiceState::awaiting_acceptance)
      return refuse("no result waits for acceptance");
    grant();
    s_.candidate = false;
    if (accept) {
      enter(ServiceState::applying, "accepted by command");
      return act(Do::apply, "accepted by command");
    }
    act(Do::reject, "rejected by command");
    enter(ServiceState::publishing, "rejected by command");
    act(Do::publish);
  }

  void asked_to_roll_back() {
    if (s_.candidate) return refuse("a result waits for acceptance: accept or reject it first");
    if (s_.state != ServiceState::idle && s_.state != ServiceState::fault)
      return refuse("the service is " + std::string(to_string(s_.state)));
    act(Do::roll_back);  // answers the command: the store knows whether there is something
  }

  // ----------------------------------------------------------------------- collecting

  void planned() {
    if (s_.state != ServiceState::planning) return;
    if (!event_.ok) return fault(event_.why);
    s_.session = event_.session;
    s_.kind = event_.kind;
    s_.step = event_.step;
    s_.steps = event_.steps;
    s_.lost_in_a_row = 0;
    s_.unfinished = false;
    if (s_.step >= s_.steps) return analyse();
    if (s_.closed && event_.via_home && !event_.back_off)
      return fault("the trigger is closed away from any touch: move the robot out by hand");
    enter(ServiceState::collecting, s_.why);
    s_.felt = false;
    if (event_.back_off) {
      s_.next_step = s_.step;
      s_.attempt = s_.failures = 0;
      s_.stray = true;
      s_.out = false;
      enter(Phase::retract);
      return act(Do::back_off);
    }
    approach(event_.via_home);
  }

  void approach(bool via_home) {
    s_.attempt = s_.failures = 0;
    s_.stray = false;
    s_.next_step = s_.step;
    s_.via_home = via_home;
    enter(Phase::approach);
    act(via_home ? Do::go_home : Do::go_to_start);
  }

  void touch() {
    s_.stray = false;
    enter(Phase::touch);
    act(Do::go_touch);
  }

  void closed() {
    s_.closed = true;
    if (s_.state != ServiceState::collecting) return;
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

  void moved() {
    if (s_.state != ServiceState::collecting) return;
    if (s_.phase == Phase::approach && s_.closed)
      return fault("the trigger is closed before " + touch_name() + ": it is stuck");
    if (s_.phase == Phase::approach && s_.via_home) {
      s_.via_home = false;
      enter(Phase::approach);
      return act(Do::go_to_start);
    }
    if (s_.phase == Phase::approach) return touch();
    if (s_.phase == Phase::touch) return act(Do::put_aside, "no touch up to the end of the search");
    if (s_.phase != Phase::retract) return;
    s_.out = true;
    back_out();
  }

  /// Out of the contact once the retract has ended and the trigger is open.
  void back_out() {
    if (s_.state != ServiceState::collecting || s_.phase != Phase::retract || !s_.out) return;
    if (s_.closed) return;  // the time limit tells when it is stuck
    if (s_.stray) return backed_off();
    if (s_.next_step == s_.step) return touch();
    s_.step = s_.next_step;
    if (s_.step >= s_.steps) return analyse();
    approach(s_.next_via_home);
  }

  void at_rest() {
    if (s_.state != ServiceState::collecting || s_.phase != Phase::settle) return;
    if (!s_.stray) return act(Do::read);
    act(Do::tell, "the trigger closed on the way to " + touch_name());
    s_.out = false;
    enter(Phase::retract);
    act(Do::back_off);
  }

  /// Out of a contact that was not looked for.
  void backed_off() {
    s_.stray = false;
    if (++s_.failures >= limits_.attempts)
      return fault("the trigger closes again and again on the way to " + touch_name() +
                   ": something stands in the way");
    s_.via_home = true;
    enter(Phase::approach);
    act(Do::go_home);
  }

  void read() {
    if (s_.state != ServiceState::collecting) return;
    ++s_.attempt;
    s_.next_step = event_.step;
    s_.next_via_home = event_.via_home;
    s_.out = false;
    if (event_.ok)
      s_.lost_in_a_row = 0;
    else if (s_.next_step != s_.step && !s_.felt)
      return fault("no touch has been felt: is the probe connected? The first: " + event_.why);
    else if (s_.next_step != s_.step && ++s_.lost_in_a_row >= limits_.most_failures)
      return fault(std::to_string(s_.lost_in_a_row) +
                   " touches in a row gave nothing; the last: " + event_.why);
    enter(Phase::retract);
    act(Do::go_back);
  }

  void refused() {
    if (s_.state != ServiceState::collecting) return;
    fault("motion to " + touch_name() + " was refused: " + event_.why);
  }

  // ------------------------------------------------------------------------ computing

  void analyse() {
    enter(ServiceState::analysing, "all touches are in");
    act(Do::analyse);
  }

  void computed() {
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

  void decided() {
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

  void publish() {
    const std::string why = s_.why;
    enter(ServiceState::publishing, why);
    act(Do::publish);
  }

  void published() {
    if (s_.state != ServiceState::publishing) return;
    ++s_.published;
    if (std::exchange(s_.follow_up, false))
      return begin(SessionKind::full, "the quick check was not explained");
    go_idle(s_.why);
  }

  // ----------------------------------------------------------------------------- time

  bool longer_than(Nanoseconds limit) const { return event_.now - s_.since > limit; }

  void tick() {
    const auto late = [&](Nanoseconds limit, const std::string& what) {
      if (longer_than(limit))
        fault(what + " took longer than " + std::to_string(limit / kSecond) + " s");
    };
    switch (s_.state) {
      case ServiceState::self_test:
        return late(limits_.self_test, "the self-test");
      case ServiceState::planning:
        return late(limits_.planning, "planning");
      case ServiceState::analysing:
      case ServiceState::identifying:
      case ServiceState::judging:
        return late(limits_.computing, std::string(to_string(s_.state)));
      case ServiceState::fault:
        // Encoders or the robot may be back; a session is resumed by a person only.
        if (longer_than(limits_.retry_self_test)) test();
        return;
      case ServiceState::collecting:
        break;
      default:
        return;
    }
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
      case Phase::none:
        return;
    }
  }

  Situation s_;
  const Event& event_;
  const Limits& limits_;
  std::vector<Action> actions_;
};

}  // namespace

Transition step(const Situation& now, const Event& event, const Limits& limits) {
  return Step(now, event, limits).run();
}

}  // namespace selfcal
