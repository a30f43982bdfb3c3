// The loop: listens, asks the transition what to do, has it done, and has the world told.
//
// The transition (transition.h) decides and knows nothing of ports. The collector makes touches,
// the analyst computes and judges what becomes of them, the reporter tells; here are the turn, what
// a person asks, and the parameters in use. No call blocks but Clock::wait and the store's own
// synchronisation.
#pragma once

#include <memory>

#include "app/service/loop/reporter.h"

namespace selfcal {

class Service {
 public:
  /// `damaged` is what the store had to set aside, or empty. All references outlive the service.
  Service(Config config, const Ports& ports, Messenger& messenger, Store& store, Journal& journal,
          Models models, const std::string& damaged);

  /// One turn: listen, step, act, tell, wait.
  void turn();
  /// Stops motion and tells so; the session goes on after the next start.
  void shut_down();

  const ExtendedState& extended_state() const { return c_.extended_state; }
  const Models& models() const { return c_.models; }

 private:
  // service.cc: the turn
  void handle_events();
  Nanoseconds longest_wait() const;
  void check_rivals();
  void begin_test();
  void check_self();
  void check_schedule();
  void look_at_clock();
  std::optional<Due> scheduled();  ///< what the schedule asks for now
  void put_due(const Due& next);
  void remember();
  void note_motion(bool moves);
  void recall();

  // service_commands.cc: what a person asks
  void handle_commands();
  void handle_command(const CommandMessage& command);
  void answer(const Action& action);
  void refuse(const CommandMessage& command, const std::string& why);
  void grant(const CommandMessage& command, const std::string& why);
  void tell_refused();

  // service_actions.cc: what the transition says
  void act(const Action& action);
  void kept(const TouchRecord* touch);
  void abort(const std::string& why);

  // service_models.cc: the parameters in use
  void apply(const std::string& why);
  void reject();
  void roll_back();
  void publish();
  void tell_result();
  bool came_about(const Result<void>& done);
  void recall_models();
  bool reload_models();
  bool use(Models models);
  void finish_interrupted_apply();

  ServiceContext c_;
  Collector collector_;
  Analyst analyst_;
  Reporter reporter_;

  Nanoseconds began_ = 0;  ///< this life of the service
  Nanoseconds test_began_ = 0;
  bool testing_ = false;
  Nanoseconds moved_ = 0;  ///< when the robot was last seen not to stand
  bool waits_ = false;     ///< what is due waits until it stands, and that was told
  Nanoseconds last_turn_ = 0, last_remembered_ = 0, last_due_ = 0, last_pruned_ = 0;
  bool moves_ = false;  ///< the store has it that a move of ours may be under way

  /// Commands that were refused, which are told once a second and not one by one.
  struct Refused {
    std::uint64_t total = 0, told = 0, unheard = 0;
    Nanoseconds told_at = 0;
    std::string last;
  };
  std::optional<CommandMessage> command_;
  Refused refused_;
};

}  // namespace selfcal
