// What a simulated robot sends where the receiving kernel takes the stamps: every frame and every
// edge at its moment, with the positions of that very moment.
//
// An edge is waited for with the eyes open, as its moment is the measurement. A frame is sent when
// it is due or a little later, and holds where the robot stands when it is sent, which is what its
// stamp will say. When the processor was away at the moment of an edge, the machine has stood still
// since its last frame, as nothing was sent that says otherwise: it goes on from there with a frame
// of its own, and the edge is waited for once more. For that no frame is sent from shortly before a
// contact until its edge, which may come a trigger's delay later.
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
  Nanoseconds late = 0;               ///< `before` less the moment at which it was due
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
  /// How often the machine had to stand still as the processor came too late for an edge.
  int pauses() const { return pauses_; }

 private:
  Nanoseconds now() { return clock_.now() - began_; }
  std::optional<Nanoseconds> next_edge() const;
  std::optional<Nanoseconds> quiet_from() const;
  bool wait_for_next();
  bool missed(Nanoseconds edge, Nanoseconds now);
  Result<void> pause();
  Result<void> drive_due();
  Result<void> drive(const Edge& edge);
  Result<void> try_sample();
  Result<void> send_sample();
  Result<std::optional<Nanoseconds>> moment_of_sample(Nanoseconds looked);

  Machine& machine_;
  JointSender& joints_;
  TriggerSender& trigger_;
  Clock& clock_;
  Nanoseconds delay_;     ///< from a contact to its edge
  Nanoseconds began_;     ///< the clock at the machine's time 0, were it always on time
  Nanoseconds told_ = 0;  ///< the machine's time of the last frame or edge
  int pauses_ = 0, in_a_row_ = 0;
  Nanoseconds preparing_ = 1000;  ///< from the look at the clock to the sending, as it was lately
  bool level_ = false;
  bool restarting_ = false;  ///< after a pause, until a frame was sent
  bool owed_ = false;        ///< a sample is due: its mark has not come, or an edge went first
  bool failing_ = false;     ///< the last sample could not be sent
  std::deque<Edge> held_;    ///< passed by the machine, not due yet
  std::vector<Edge> edges_;
  std::vector<EncoderSample> samples_;
  std::vector<double> q_;
  std::vector<DrivenEdge> driven_;
};

/// One JSON object a line: closed, before_ns, after_ns, late_ns, label, q, dq.
std::string driven_text(const std::vector<DrivenEdge>& driven);

}  // namespace selfcal
