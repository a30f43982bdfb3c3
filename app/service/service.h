// The loop: listens to the ports, asks the transition what to do, does it, and tells the world.
//
// The transition (transition.h) decides and knows nothing of ports; this class does what it is told
// and decides nothing. No call blocks but Clock::wait and the store's own synchronisation.
#pragma once

#include <deque>
#include <memory>

#include "app/service/acceptance.h"
#include "app/service/computation.h"
#include "app/service/config.h"
#include "app/service/journal.h"
#include "app/service/models.h"
#include "app/service/sensor_front_end.h"
#include "app/service/session.h"
#include "constraints/estimation/engagements.h"
#include "io/messages.h"
#include "io/supervisor.h"

namespace selfcal {

class Service {
 public:
  /// `damaged` is what the store had to set aside, or empty. All references outlive the service.
  Service(Config config, const Ports& ports, Messenger& messenger, Store& store, Journal& journal,
          Models models, std::string damaged);

  /// One turn: listen, step, act, tell, wait.
  void turn();
  /// Stops motion and tells so; the session goes on after the next start.
  void shut_down();

  const Situation& situation() const { return situation_; }

 private:
  // service.cc: the turn
  void listen();
  void handle_events();
  void put(Event event);
  void put(Event::What what, bool ok = true, std::string why = {});
  /// False, with a fault on its way, when the store has failed.
  template <class T>
  bool stored(const Result<T>& result);
  Nanoseconds longest_wait() const;

  // service_checks.cc: what is looked at in every turn
  void check_senses();
  void check_rivals();
  std::string rivals() const;
  void begin_test();
  void check_self();
  std::string missing() const;
  std::string two_senders() const;
  std::string beyond_limits() const;
  void check_rest();
  void check_stop();
  void check_schedule();

  // service_commands.cc: what a person asks
  void handle_command(const CommandMessage& command);
  void answer(const Action& action);
  void refuse(const CommandMessage& command, const std::string& why);
  void tell_refused();

  // service_actions.cc: what the transition says
  void act(const Action& action);

  // service_motion.cc: what the robot is asked
  void make_move(Action::Do what);
  void move(MoveKind kind, const std::vector<double>& q, double speed);
  void stop(const std::string& why);
  double touch_speed(const StepRecord& step) const;
  std::string label() const;
  void release();

  // service_session.cc: from the plan to the last touch
  std::string config_hash() const;
  bool can_check() const;
  void begin_plan(const std::string& why);
  void keep_plan(SessionRecord record, const TouchPlan& plan);
  void resume();
  bool open(Session session);
  void announce_plan();
  int repeats() const;
  void tell_way(int step, Event& event) const;
  int lock_of(int step) const;
  void read();
  void read_touch();
  void read_visit();
  void outlier(const std::string& why);
  void keep(TouchRecord touch);
  void abort(const std::string& why);

  // service_result.cc: from the rows to the decision
  void analyse();
  void join_base();
  void identify();
  void keep_solution(Engagements found);
  void give_up();
  void judge();
  ResultRecord new_result() const;
  ResultRecord result_of_failure(const std::string& why) const;
  ResultRecord result_of_check();
  ResultRecord result_of_candidate() const;
  void keep_result(const ResultRecord& result);
  void apply(const std::string& why);
  void reject();
  void roll_back();
  void publish();
  void publish(const ResultRecord& result);
  bool reload_models();
  /// A power cut came between the ruling and the change of the slots.
  void finish_interrupted_apply();

  // service_report.cc: what is told
  void report();
  void tell(const std::string& level, const std::string& text);
  void tell_progress(const TouchRecord* touch, const std::string& note);
  StatusMessage status() const;
  void remember_use();
  void remember_held();
  void recall_use();

  // service_health.cc: how well everything is
  void recall_damage();
  void tell_damage();
  void report_health(bool in_any_case);
  std::vector<HealthMessage> health() const;
  HealthMessage health_of_service() const;
  HealthMessage health_of_encoders() const;
  HealthMessage health_of_trigger() const;
  HealthMessage health_of_store() const;
  HealthMessage health_of_calibration() const;

  Config config_;
  Ports ports_;
  Messenger& messenger_;
  Store& store_;
  Journal& journal_;
  Models models_;
  std::string damaged_, damaged_before_;  ///< of the store: found now, and in earlier lives
  std::size_t damage_told_ = 0;           ///< of Store::met
  Supervisor supervisor_;
  Reflex reflex_;
  SensorFrontEnd senses_;
  Situation situation_;
  std::deque<Event> events_;
  Nanoseconds now_ = 0;

  std::uint64_t motion_id_ = 0;
  bool outstanding_ = false;  ///< a move of ours may be under way
  Nanoseconds stopped_ = 0;   ///< when the robot was last told to stop; 0 once it stands
  Nanoseconds began_ = 0;     ///< this life of the service
  std::vector<double> asked_,
      reached_;  ///< readings: target of the last move, of the last that ended
  Nanoseconds test_began_ = 0;
  bool testing_ = false;

  Session session_;
  Decoding meaning_;
  Nanoseconds collecting_since_ = 0;
  int touches_this_run_ = 0;

  Computation computation_;
  std::function<void(const std::string& failure)> when_computed_;
  std::shared_ptr<DataSet> data_, base_;
  std::shared_ptr<Solution> solution_, unchanged_;
  std::optional<CheckRuling> last_check_;

  /// Commands that were refused, which are told once a second and not one by one.
  struct Refused {
    std::uint64_t total = 0, told = 0, unheard = 0;
    Nanoseconds told_at = 0;
    std::string last;
  };
  std::optional<CommandMessage> command_;
  Refused refused_;
  Since since_;
  double motion_hours_ = 0;
  Nanoseconds last_turn_ = 0, last_report_ = 0, last_health_ = 0, last_remembered_ = 0,
              last_due_ = 0;
  Situation told_;  ///< as last published
  std::string last_told_;
  Nanoseconds last_told_at_ = 0;
  std::string told_active_, last_levels_, last_stage_;
};

}  // namespace selfcal
