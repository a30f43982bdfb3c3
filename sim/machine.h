// The simulated robot: the true robot among the true surfaces, moved and felt through the ports.
//
// It moves on straight joint paths with finite speed and acceleration. The place of a contact on a
// path is known when the move begins: the endpoint of the true robot crosses a true surface within
// its patch, early or late by the touch's own noise; so an edge has its exact moment however rarely
// the machine is asked. What a touch is off by depends on its label alone: the same touch repeated
// after a power cut reads the same.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "io/ports.h"
#include "sim/data_set_maker.h"
#include "sim/trajectory.h"
#include "sim/true_robot.h"

namespace selfcal {

/// A true plane within its patch: outside where outward . p > d.
struct TrueSurface {
  int set;
  Eigen::Vector3d outward;
  double d;
  Patch within;
};

class Machine {
 public:
  /// The machine of a scenario with a `machine` section, standing at `home` at time 0. A set needs
  /// `within` and, as far as its place is unknown, `surface` or `truth`. What cannot be is a
  /// problem.
  Machine(const Scenario& scenario, std::shared_ptr<const Robot> robot, Eigen::VectorXd home,
          Problems& problems);

  /// Lets time pass up to `now`.
  void advance(Nanoseconds now);
  Nanoseconds now() const { return now_; }
  /// True from a request to half a second after the robot stands.
  /// Or while a lock is on its way.
  bool busy() const;
  bool moving() const { return moving_.has_value(); }
  /// The moment after now() at which the next sample is taken.
  Nanoseconds next_sample() const;
  /// When the contact that lies next on the path shows at the trigger, as the path stands now;
  /// nothing when none does. It comes out of take() once its contact is passed.
  std::optional<Nanoseconds> next_edge() const;
  /// True joint readings at a moment, as the path stands now: neither rounded nor sampled.
  Eigen::VectorXd readings(Nanoseconds t) const { return path_.q(t); }
  /// What the encoders count at a moment, as the path stands now.
  EncoderSample sample(Nanoseconds t) const;

  void request(const MotionRequest& request);
  void stop(const std::string& why);
  /// What came since the last call, oldest first; the oldest are dropped beyond the ports' bounds.
  void take(std::vector<EncoderSample>& out);
  void take(std::vector<Edge>& out);
  void take(std::vector<MotionReply>& out);
  bool closed() const { return closed_; }
  double celsius() const;

  const std::vector<EncoderScale>& scales() const { return scales_; }
  const MachineScenario& settings() const { return settings_; }
  /// Of the last move.
  const std::string& label() const { return label_; }
  const State& truth() const { return truth_; }
  const Robot& robot() const { return *robot_; }
  const std::vector<Set>& sets() const { return sets_; }
  /// Labels of the touches whose trigger fired early, in the order in which they were made.
  const std::vector<std::string>& false_touches() const { return false_touches_; }
  /// Whether a touch of this label fires early, or would.
  bool is_false(const std::string& label) const;
  /// How often each label was moved for.
  const std::map<std::string, int>& visits() const { return visits_; }

 private:
  /// The trigger's level changes at this place of the path.
  struct Crossing {
    double s;
    bool closes;
  };

  bool broken(MachineFault::What what, Nanoseconds t) const;
  std::string cannot_stand(const MotionRequest& request) const;
  void begin(const MotionRequest& request);
  void reply(std::uint64_t id, MotionReply::Outcome outcome, std::string why);
  void pass_crossings(Nanoseconds until);
  void put_edge(Nanoseconds time, bool closed);
  void stick(Nanoseconds until);
  Nanoseconds period() const { return nanoseconds(settings_.encoder_period); }

  void add_effects(Problems& problems);

  // sim/machine_lock.cc
  void turn_lock(const MotionRequest& request);
  void pass_lock(Nanoseconds until);
  void engage(int set);
  int set_of_lock(const std::string& lock) const;
  void slip();
  Eigen::VectorXd give_way(const MotionRequest& request);

  // sim/machine_contact.cc
  std::vector<Crossing> crossings(const MotionRequest& request, const Trajectory& path);
  Eigen::VectorXd seat(const MotionRequest& request, const Eigen::VectorXd& from);
  struct Chance {
    double noise;  ///< in sigmas
    bool missed;
    double early;  ///< m, of a false trigger; 0 for a true one
  };
  Chance chance_of(const std::string& label) const;
  double offset(const MotionRequest& request, int set);
  Random stream_of(const std::string& label) const;
  Eigen::ArrayXXd true_joints(const Eigen::ArrayXXd& readings) const;
  MeasurementConditions conditions(const MotionRequest& request, const Trajectory& path,
                                   const TrueSurface& surface) const;
  void hang_payload(ConfigurationBlock& block) const;

  Scenario scenario_;
  MachineScenario settings_;
  std::shared_ptr<const Robot> robot_;
  std::vector<Set> sets_;
  State truth_;
  std::vector<TrueSurface> surfaces_;
  std::optional<Compliance> compliance_;
  std::vector<EncoderScale> scales_;

  Nanoseconds now_ = 0, sampled_ = 0, last_motion_ = 0;
  Trajectory path_;
  std::optional<MotionRequest> moving_;
  std::string label_;
  std::vector<Crossing> ahead_;  // not yet reached on the path, in the order of s
  double contact_offset_ = 0;    // m, at which the touch in progress triggers
  int contact_set_ = -1;
  /// A lock on its way to engage (its set) or to open (-1).
  struct LockTurn {
    std::uint64_t id = 0;
    Nanoseconds due = 0;
    int set = -1;
  };
  std::optional<LockTurn> turn_;
  int locked_ = -1;  // set of the lock that is engaged
  int lock_visits_ = 0;
  bool closed_ = false, stuck_ = false;
  std::deque<EncoderSample> samples_;
  std::deque<Edge> edges_;
  std::deque<MotionReply> replies_;
  std::vector<std::string> false_touches_;
  std::map<std::string, int> visits_;
};

}  // namespace selfcal
