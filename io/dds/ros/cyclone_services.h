// An action's services in rmw_cyclonedds' encoding (follow_joint_trajectory.idl): send_goal,
// get_result and cancel_goal, whose replies name the client and its request.
#pragma once

#include <memory>

#include "io/dds/ros/goal_services.h"

namespace selfcal {

class CycloneServices final : public GoalServices {
 public:
  /// `wakeup` hears of replies and of servers that come and go.
  static Result<std::unique_ptr<GoalServices>> open(const DdsParticipant& participant,
                                                    const std::string& action,
                                                    std::vector<std::string> joints,
                                                    Wakeup& wakeup);

  bool connected() const override;
  bool other_encoding() const override;
  Result<void> send(const GoalId& goal, const std::vector<TrajectoryPoint>& points) override;
  Result<void> cancel(const GoalId& goal) override;
  Result<void> take(std::vector<GoalNews>& out) override;

 private:
  struct Endpoints {
    DdsWriter<dds::SendGoalRequest> send;
    DdsReader<dds::SendGoalReply> sent;
    DdsWriter<dds::GetResultRequest> ask;
    DdsReader<dds::GetResultReply> result;
    DdsWriter<dds::CancelRequest> cancel;
    DdsReader<dds::CancelReply> cancelled;
  };
  CycloneServices(std::vector<std::string> joints, Endpoints endpoints);
  Result<void> ask_for_result();

  std::vector<std::string> joints_;
  Endpoints dds_;
  std::uint64_t client_ = 0;  ///< in every request; whose replies are ours
  std::int64_t number_ = 0, sent_ = 0, asked_ = 0;
  GoalId goal_{};
};

}  // namespace selfcal
