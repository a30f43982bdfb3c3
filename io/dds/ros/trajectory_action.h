// A client of the ROS 2 action control_msgs/action/FollowJointTrajectory, without ROS: its three
// services in rmw_cyclonedds' encoding (follow_joint_trajectory.idl). Servers of other
// implementations of ROS 2's middleware encode services in another way and are not met.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/dds/ros/action_types.h"

namespace selfcal {

using GoalId = std::array<std::uint8_t, 16>;

struct TrajectoryPoint {
  double time = 0;            ///< s after the start
  std::vector<double> q, dq;  ///< by joint (rad or m, and per second)
};

/// What an action's server said of a goal.
struct GoalNews {
  enum class What : std::uint8_t { accepted, rejected, done, cancelled, aborted };
  GoalId goal{};
  What what = What::rejected;
  std::string why;  ///< of `aborted`: the error's name and the server's words
};

class TrajectoryAction {
 public:
  /// `action` is the name in ROS, "/arm_controller/follow_joint_trajectory". `wakeup` hears of
  /// replies and of servers that come and go.
  static Result<std::unique_ptr<TrajectoryAction>> open(const DdsParticipant& participant,
                                                        const std::string& action,
                                                        std::vector<std::string> joints,
                                                        Wakeup& wakeup);

  /// Whether a server of all three services is there.
  bool connected() const;
  /// Asks for the goal; its acceptance and its end come as news. One goal at a time: of the one
  /// before nothing is told any more.
  Result<void> send(const GoalId& goal, const std::vector<TrajectoryPoint>& points);
  /// Asks to cancel the goal, or every goal of the server (a goal of zeros).
  Result<void> cancel(const GoalId& goal);
  /// Appends what has come since the last call.
  Result<void> take(std::vector<GoalNews>& out);

 private:
  struct Endpoints {
    DdsWriter<dds::SendGoalRequest> send;
    DdsReader<dds::SendGoalReply> sent;
    DdsWriter<dds::GetResultRequest> ask;
    DdsReader<dds::GetResultReply> result;
    DdsWriter<dds::CancelRequest> cancel;
    DdsReader<dds::CancelReply> cancelled;
  };
  TrajectoryAction(std::vector<std::string> joints, Endpoints endpoints);
  Result<void> ask_for_result();

  std::vector<std::string> joints_;
  Endpoints dds_;
  std::uint64_t client_ = 0;  ///< in every request; whose replies are ours
  std::int64_t number_ = 0, sent_ = 0, asked_ = 0;
  GoalId goal_{};
};

}  // namespace selfcal
