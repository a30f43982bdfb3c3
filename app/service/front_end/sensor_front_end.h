// What the ports tell, condensed: the last samples, the debounced trigger, the answers to the last
// move.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "app/service/front_end/reading.h"
#include "app/service/front_end/reflex.h"
#include "app/service/transitions/transition.h"

namespace selfcal {

class SensorFrontEnd {
 public:
  /// `reflex` watches the trigger of the ports and outlives this; `units` are units_of_readings of
  /// the robot.
  SensorFrontEnd(const Ports& ports, Reflex& reflex, Eigen::ArrayXd units, double rest,
                 Nanoseconds silence)
      : ports_(ports), reflex_(reflex), units_(std::move(units)), rest_(rest), silence_(silence) {}

  /// Takes what has come in and appends what the service must know of it.
  void listen(Nanoseconds now, std::deque<Event>& events);

  /// Moves of this id are the ones whose end counts; 0 for none.
  void expect(std::uint64_t motion_id) { expected_ = motion_id; }

  const SampleHistory& samples() const { return samples_; }
  bool encoders_alive(Nanoseconds now) const {
    return !samples_.empty() && now - heard_ <= silence_;
  }
  std::optional<bool> at_rest() const;
  bool moving() const { return at_rest() == false; }
  /// The debounced level; nothing while the trigger is not known or gone.
  std::optional<bool> closed() const { return trigger_.known ? trigger_.level : std::nullopt; }
  const TriggerNews& trigger() const { return trigger_; }
  /// The first closing since forget_closing(): a probe may bounce while the robot brakes.
  const std::optional<Edge>& closing() const { return closing_; }
  void forget_closing() { closing_.reset(); }
  std::optional<double> celsius() const {
    return ports_.thermometer ? ports_.thermometer->celsius() : std::nullopt;
  }
  /// Joint readings now; nothing before the first sample.
  std::optional<Eigen::VectorXd> q() const;

  std::uint64_t samples_dropped() const { return ports_.encoders->dropped(); }
  double rate() const { return rate_; }  ///< samples per second, over the last ones

 private:
  void listen_to_encoders(Nanoseconds now, std::deque<Event>& events);
  void listen_to_trigger(Nanoseconds now, std::deque<Event>& events);
  void listen_to_motion(Nanoseconds now, std::deque<Event>& events);

  Ports ports_;
  SampleHistory samples_;
  Reflex& reflex_;
  TriggerNews trigger_;
  Eigen::ArrayXd units_;
  double rest_;
  Nanoseconds silence_, heard_ = 0, counted_from_ = 0, period_ = 0;
  std::optional<Edge> closing_;
  std::uint64_t expected_ = 0, counted_ = 0;
  double rate_ = 0;
  std::vector<EncoderSample> new_samples_;
  std::vector<MotionReply> new_replies_;
};

}  // namespace selfcal
