// A client of the ROS 2 action control_msgs/action/FollowJointTrajectory, without ROS: its services
// in the encoding of the server that is there (goal_services.h), rmw_cyclonedds' until one is seen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dds/ros/goal_services.h"

namespace selfcal {

class TrajectoryAction {
 public:
  /// `action` is the name in ROS, "/arm_controller/follow_joint_trajectory". `wakeup` hears of
  /// replies and of servers that come and go. Participant and wakeup outlive this.
  static Result<std::unique_ptr<TrajectoryAction>> open(const DdsParticipant& participant,
                                                        const std::string& action,
                                                        std::vector<std::string> joints,
                                                        Wakeup& wakeup);

  /// Whether a server of all services is there.
  bool connected() const { return services_->connected(); }
  /// Asks for the goal; its acceptance and its end come as news. One goal at a time: of the one
  /// before nothing is told any more.
  Result<void> send(const GoalId& goal, const std::vector<TrajectoryPoint>& points) {
    return services_->send(goal, points);
  }
  /// Asks to cancel the goal, or every goal of the server (a goal of zeros).
  Result<void> cancel(const GoalId& goal) { return services_->cancel(goal); }
  /// Appends what has come since the last call. A server that encodes in another way than the one
  /// before is spoken to in its own from here on.
  Result<void> take(std::vector<GoalNews>& out);

 private:
  TrajectoryAction(const DdsParticipant& participant, std::string action,
                   std::vector<std::string> joints, Wakeup& wakeup);
  Result<void> open_services();

  const DdsParticipant& participant_;
  std::string action_;
  std::vector<std::string> joints_;
  Wakeup& wakeup_;
  bool fast_ = false;  ///< the server is Fast DDS's
  std::unique_ptr<GoalServices> services_;
};

}  // namespace selfcal
