// One transition in the making: what the event makes of the state, topic by topic.
//
//   transition.cc             which event goes where; entering a state, faults
//   transition_sessions.cc    the self-test, and how a session begins or goes on
//   transition_commands.cc    what a person asks for
//   transition_collecting.cc  touch by touch: approach, touch, settle, retract
//   transition_locks.cc       configurations with a joint locked: lock, visit, settle, release
//   transition_computing.cc   from the touches to the decision and its result
//   transition_time.cc        what takes too long
#pragma once

#include <string>
#include <vector>

#include "app/service/transitions/transition.h"

namespace selfcal {

class TransitionStep {
 public:
  TransitionStep(const ExtendedState& now, const Event& event, const Limits& limits)
      : s_(now), event_(event), limits_(limits) {}

  Transition run();

 private:
  using Do = Action::Do;

  // transition.cc
  void handle();
  void act(Do what, std::string why = {}) { actions_.push_back({what, std::move(why)}); }
  void enter(ServiceState state, std::string why);
  void enter(Phase phase);
  void fault(const std::string& why);
  void tell_of_load();
  std::string touch_name() const;
  std::string release_name() const;

  // transition_sessions.cc
  void test();
  void self_tested();
  void go_idle(std::string why);
  void due();
  void begin(SessionKind kind, const std::string& why);
  void resume(const std::string& why);
  void postpone();
  bool in_session() const;  ///< planning up to judging: what an abort can end

  // transition_commands.cc
  void commanded();
  void commanded_to_start(SessionKind kind);
  void commanded_to_abort();
  void told_done();
  void commanded_to_accept();
  void commanded_to_reject();
  void commanded_to_roll_back();
  void grant() { act(Do::grant, std::string(to_string(event_.verb))); }
  void refuse(const std::string& why) { act(Do::refuse, why); }
  void rolled_back();
  void refuse_without_result();
  void refuse_in_this_state() { refuse("the service is " + std::string(to_string(s_.state))); }

  // transition_collecting.cc
  void planned();
  void approach();
  void come();
  void come_in();
  void touch();
  void closed();
  void opened();
  void moved();
  void at_rest();
  void back_off();
  void back_out();
  void go_on();
  void go_on_loaded();
  void ask_for_load();
  void backed_off();
  void read();
  void refused();

  // transition_locks.cc
  void lock();
  void locked();
  void visit();
  void visited();
  void release();
  void released();
  void let_go();

  // transition_computing.cc
  void analyse();
  void computed();
  void diagnose(std::string why);
  void decided();
  void applied();
  void publish();
  void published();

  // transition_time.cc
  void tick();
  void tick_collecting();
  bool longer_than(Nanoseconds limit) const { return event_.now - s_.since > limit; }
  void late(Nanoseconds limit, const std::string& what);

  ExtendedState s_;
  const Event& event_;
  const Limits& limits_;
  std::vector<Action> actions_;
};

}  // namespace selfcal
