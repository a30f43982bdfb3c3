// What a pretend robot sends where the receiving kernel takes the stamps: every frame and every
// edge at its moment, with the positions of that very moment.
//
// An edge is waited for with the eyes open, as its moment is the measurement. A frame is sent when
// it is due or a little later, and holds where the robot stands when it is sent, which is what its
// stamp will say.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "io/transport.h"
#include "sim/machine.h"

namespace selfcal {

/// An edge that was driven, and the truth of its moment.
struct DrivenEdge {
  bool closed = false;
  Nanoseconds before = 0, after = 0;  ///< of the driving (CLOCK_MONOTONIC)
  std::string label;                  ///< of the move in which it came
  Eigen::VectorXd q, dq;  ///< true readings and speeds at `before` less the trigger's delay
};

class PacedOutput {
 public:
  /// The machine's time 0 is now. All of them outlive the output.
  PacedOutput(Machine& machine, JointSender& joints, TriggerSender& trigger, Clock& clock);

  /// Waits for what is due next, an edge or a sample, lets the machine's time pass and sends it;
  /// earlier, without anything sent, when the clock has news.
  Result<void> turn();
  /// False when an edge is due so soon that nothing else should be done before it.
  bool at_leisure();
  /// Drives the level once more, as it was driven last.
  Result<void> repeat() { return trigger_.send(now(), level_); }

  const std::vector<DrivenEdge>& driven() const { return driven_; }

 private:
  Nanoseconds now() { return clock_.now() - began_; }
  std::optional<Nanoseconds> next_edge() const;
  bool wait_for_next();
  Result<void> drive(const Edge& edge);
  Result<void> send_sample();
  Result<std::optional<Nanoseconds>> moment_of_sample();

  Machine& machine_;
  JointSender& joints_;
  TriggerSender& trigger_;
  Clock& clock_;
  Nanoseconds began_;
  Nanoseconds preparing_ = 1000;  ///< from the look at the clock to the sending, as it was lately
  bool level_ = false;
  bool owed_ = false;      ///< a sample is due: its mark has not come, or an edge went first
  bool failing_ = false;   ///< the last sample could not be sent
  std::deque<Edge> held_;  ///< passed by the machine, not due yet
  std::vector<Edge> edges_;
  std::vector<EncoderSample> samples_;
  std::vector<double> q_;
  std::vector<DrivenEdge> driven_;
};

/// One JSON object a line: closed, before_ns, after_ns, label, q, dq.
std::string driven_text(const std::vector<DrivenEdge>& driven);

}  // namespace selfcal
