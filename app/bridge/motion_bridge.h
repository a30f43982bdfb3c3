// Motion requests of the service as goals of a trajectory controller.
//
//   request → known position? → server there? → send_goal → accepted → result → done, stopped
//   stop → cancel_goal, again until the result comes
// One move at a time; one more may wait for the end of a move that is being stopped. Nothing waits
// longer than the bridge's patience: what does not come is refused or told as stopped, by name.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/dds/robot_side.h"
#include "io/dds/ros/trajectory_action.h"
#include "io/ports.h"
#include "kinematics/robot.h"

namespace selfcal {

struct MotionBridgeOptions {
  double acceleration = 1;             ///< rad/s^2 or m/s^2, of any joint; above 0
  Nanoseconds patience = 2 * kSecond;  ///< with a server that does not answer
  Nanoseconds slack = 5 * kSecond;     ///< beyond twice the time that a trajectory takes
  Nanoseconds freshest = kSecond / 2;  ///< a position older than this is not known
  std::string action;                  ///< for messages
};

class MotionBridge {
 public:
  MotionBridge(MotionBridgeOptions options, const std::vector<Joint>& joints, DdsRobotSide& service,
               TrajectoryAction& action)
      : options_(std::move(options)), joints_(joints), service_(service), action_(action) {}

  /// Where the joints are, seen at `time` (our clock).
  void see(std::vector<double> q, Nanoseconds time);
  /// Looks at what has come: the newest sample is of now. Its own stamp is the sender's, whose
  /// clock may step or drift.
  Result<void> look(EncoderSource& encoders, Nanoseconds now);
  /// Hears the service and the controller, and answers both.
  Result<void> turn(Nanoseconds now);
  /// Cancels what moves, as turn() goes on to do until it stands; nothing begins from now on.
  Result<void> give_up(Nanoseconds now);
  /// Whether a move has not ended.
  bool moving() const { return move_.has_value(); }

 private:
  struct Move {
    MotionRequest request;
    GoalId goal{};
    bool sent = false, accepted = false, stopping = false;
    std::string why{};  ///< of the stop
    Nanoseconds since = 0, until = 0, cancelled = 0;
  };
  Result<void> hear(const RobotRequest& request, Nanoseconds now);
  Result<void> begin(const MotionRequest& request, Nanoseconds now);
  Result<void> stop(const std::string& why, Nanoseconds now);
  Result<void> send(Nanoseconds now);
  Result<void> hear(const GoalNews& news, Nanoseconds now);
  Result<void> watch(Nanoseconds now);
  Result<void> end(MotionReply::Outcome outcome, const std::string& why);
  Result<void> refuse(const MotionRequest& request, const std::string& why);
  std::string why_not(const MotionRequest& request, Nanoseconds now) const;

  MotionBridgeOptions options_;
  const std::vector<Joint>& joints_;
  DdsRobotSide& service_;
  TrajectoryAction& action_;
  std::vector<EncoderSample> samples_;
  std::vector<double> here_;
  Nanoseconds seen_ = 0;
  std::optional<Move> move_;
  std::optional<MotionRequest> next_;
  bool ending_ = false;
};

}  // namespace selfcal
