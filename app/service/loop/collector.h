// The session in progress at the robot: listens to its ports, asks it to move, and makes touches of
// what comes back. Each touch is in the store before the robot moves on.
#pragma once

#include "app/service/front_end/sensor_front_end.h"
#include "app/service/loop/context.h"
#include "app/service/session/decoding.h"
#include "app/service/session/session.h"

namespace selfcal {

class Collector {
 public:
  /// `context` outlives it.
  explicit Collector(ServiceContext& context);

  // collector_checks.cc: what is looked at in every turn
  /// Takes what has come in; what a robot that may move cannot do without, and is not there, is a
  /// fault on its way.
  void listen();
  /// An event once the joints stand after a touch.
  void check_rest();
  /// A stop may be lost on the way, or come before the robot listens: it is said until it stands.
  void check_stop();
  /// The topic that somebody beside the robot writes; empty when there is none.
  std::string two_senders() const;
  /// Why the robot must not go on from where a person who has changed its payload has left it;
  /// empty when it may, or has nowhere to go.
  std::string unfit_to_go_on() const;
  /// The joints are heard and stand.
  bool stands() const { return front_end_.encoders_alive(c_.now) && front_end_.at_rest() == true; }
  /// That another service of this robot is in the DDS domain, where both would move it; empty when
  /// none is.
  std::string rivals() const;
  /// What is still missing for the self-test to pass; empty when nothing is.
  std::string missing() const;

  // collector_motion.cc: what the robot is asked
  /// The move of an action, for the touch in progress.
  void make_move(Action::Do what);
  void stop(const std::string& why);
  /// Opens whatever lock is engaged: as a move of its own while collecting, whose end is waited
  /// for; else beside the stop, which is said again until the robot stands.
  void release();
  /// A move of an earlier life may be under way.
  void expect_motion() { outstanding_ = true; }
  /// A move of ours may be.
  bool moves() const { return outstanding_; }
  /// The last move has ended as asked.
  void arrived();

  // collector.cc: from the plan to the last touch
  /// Begins with what is planned or stored; an event says where, or why not.
  void open(Session session);
  /// One that has nothing to touch.
  void hold(Session session) { session_ = std::move(session); }
  /// The unfinished session of the store.
  void resume();
  /// Judges and stores the touch whose edge was seen, or the configuration under a lock; null where
  /// nothing could be stored.
  const TouchRecord* read();
  /// Stores the attempt as failed.
  const TouchRecord* outlier(const std::string& why);

  const SensorFrontEnd& front_end() const { return front_end_; }
  const Reflex& reflex() const { return reflex_; }
  const Session& session() const { return session_; }
  const Decoding& decoding() const { return decoding_; }
  /// Good touches that a configuration needs.
  int repeats() const;
  /// The first step that needs another touch.
  int next() const;
  /// The lock that a step wants engaged, by its set from 1; 0 for none.
  int lock_of(int step) const;
  /// Mean time of a touch in this run (s); NaN before the first.
  double seconds_each() const;

 private:
  static constexpr const char* kShutIn =
      "no free way home from where the robot stands: move it there by hand";

  std::string beyond_limits() const;
  /// Why the robot must not be moved now, wherever it stands; empty when it may.
  std::string unfit() const;
  /// No free way leads home.
  bool is_shut_in(const Eigen::VectorXd& here) const;
  void move(MoveKind kind, const std::vector<double>& q, double speed);
  /// No move of ours is under way: what moves now is not ours to stop.
  void leave_alone();
  double touch_speed(const StepRecord& step) const;
  /// Readings from which on the touch of a step is slow; its start where nothing tells more.
  std::vector<double> slow_from(int step) const;
  std::string label() const;
  void announce_plan();
  /// Of a session that is in the store.
  void refuse_plan(const std::string& why, bool later = false);
  void tell_way(int step, Event& event) const;
  bool may_come_nearer(int step) const;
  bool is_loaded(int step) const;
  /// The plan has touches with the payload, so that it may be on the tool.
  bool touched_loaded() const;
  const TouchRecord* read_touch();
  const TouchRecord* read_visit();
  const TouchRecord* keep(TouchRecord touch);

  ServiceContext& c_;
  Reflex reflex_;
  SensorFrontEnd front_end_;
  std::uint64_t motion_id_ = 0;
  bool outstanding_ = false;  ///< a move of ours may be under way
  Nanoseconds stopped_ = 0;   ///< when it was last told to stop; 0 once it stands
  /// Readings: target of the last move; of the last that ended; where the last one into the cell
  /// began, which is free even if it ended in a contact.
  std::vector<double> target_, reached_, began_;
  Session session_;
  Decoding decoding_;
  Nanoseconds collecting_since_ = 0;
  int touches_this_run_ = 0;
  bool recalled_ = false;  ///< the session is one of an earlier life
};

}  // namespace selfcal
