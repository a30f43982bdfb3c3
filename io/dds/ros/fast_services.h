// An action's services in rmw_fastrtps' encoding: the fields alone, for what relates a reply to its
// request goes beside the data, where only Fast DDS reads it. A request needs nothing of that: its
// server knows it by its writer and number. Replies cannot be told from those to other clients, so
// what becomes of a goal is read from the action's topic `status`, which names goals.
#pragma once

#include <memory>

#include "io/dds/ros/goal_services.h"

namespace selfcal {

class FastServices final : public GoalServices {
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
    DdsWriter<dds::FastSendGoalRequest> send;
    DdsReader<dds::FastSendGoalReply> sent;
    DdsWriter<dds::FastCancelRequest> cancel;
    DdsReader<dds::GoalStatusArray> status;
  };
  /// How far the last goal is known to be.
  enum class Stage : std::uint8_t { none, sent, rejected, accepted };
  FastServices(std::vector<std::string> joints, Endpoints endpoints)
      : joints_(std::move(joints)), dds_(std::move(endpoints)) {}
  void hear(int status, std::vector<GoalNews>& out);

  std::vector<std::string> joints_;
  Endpoints dds_;
  GoalId goal_{};
  Stage stage_ = Stage::none;
};

}  // namespace selfcal
