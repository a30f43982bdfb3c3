// An action's services in rmw_fastrtps' encoding.
#include "io/dds/ros/fast_services.h"

#include <algorithm>

#include "io/dds/opened.h"

namespace selfcal {

Result<std::unique_ptr<GoalServices>> FastServices::open(const DdsParticipant& participant,
                                                         const std::string& action,
                                                         std::vector<std::string> joints,
                                                         Wakeup& wakeup) {
  Endpoints all;
  DdsOpening opening(participant);
  opening.open(all.send, action_request_topic(action, "send_goal"), kExchange, &wakeup);
  opening.open(all.sent, action_reply_topic(action, "send_goal"), kExchange, &wakeup);
  opening.open(all.cancel, action_request_topic(action, "cancel_goal"), kExchange, &wakeup);
  opening.open(all.status, action_status_topic(action), kLatchedReader, &wakeup);
  return opening.finish([&] {
    return std::unique_ptr<GoalServices>(new FastServices(std::move(joints), std::move(all)));
  });
}

bool FastServices::connected() const {
  return dds_.send.matched() > 0 && dds_.sent.matched() > 0 && dds_.cancel.matched() > 0 &&
         dds_.status.matched() > 0 && !other_encoding();
}

bool FastServices::other_encoding() const {
  const WritersByVendor writers = writers_by_vendor(dds_.sent.handle());
  return writers.others > 0 && writers.fast_dds == 0;
}

Result<void> FastServices::send(const GoalId& goal, const std::vector<TrajectoryPoint>& points) {
  dds::FastSendGoalRequest request{};
  goal_ = goal;
  stage_ = Stage::sent;
  std::ranges::copy(goal, request.goal_id_);
  const BorrowedGoal borrowed(joints_, points);
  request.goal_ = borrowed.goal();
  return dds_.send.write(request);
}

Result<void> FastServices::cancel(const GoalId& goal) {
  dds::FastCancelRequest request{};
  std::ranges::copy(goal, request.goal_info_.goal_id_);
  return dds_.cancel.write(request);
}

/// The last goal's status of action_msgs/msg/GoalStatus: 1 accepted, 2 executing, 3 canceling,
/// 4 succeeded, 5 canceled, 6 aborted.
void FastServices::hear(int status, std::vector<GoalNews>& out) {
  using What = GoalNews::What;
  if (stage_ == Stage::none || status < 1 || status > 6) return;
  if (stage_ != Stage::accepted) out.push_back({goal_, What::accepted, {}});
  stage_ = status < 4 ? Stage::accepted : Stage::none;
  if (status == 4) out.push_back({goal_, What::done, {}});
  if (status == 5) out.push_back({goal_, What::cancelled, {}});
  if (status == 6) out.push_back({goal_, What::aborted, "aborted; its log says why"});
}

Result<void> FastServices::take(std::vector<GoalNews>& out) {
  auto taken = dds_.status.take([&](const dds::GoalStatusArray& array) {
    for (std::uint32_t i = 0; i < array.status_list_._length; ++i) {
      const auto& each = array.status_list_._buffer[i];
      if (std::ranges::equal(each.goal_info_.goal_id_, goal_)) hear(each.status_, out);
    }
  });
  if (!taken) return taken;
  bool rejected = false;
  taken = dds_.sent.take([&](const dds::FastSendGoalReply& reply) {
    rejected = rejected || (!reply.accepted_ && stage_ == Stage::sent);
  });
  if (!taken || !rejected) return taken;
  // Another client's goal may be meant: ours must not move then either. It may be accepted yet.
  stage_ = Stage::rejected;
  out.push_back({goal_, GoalNews::What::rejected, {}});
  return cancel(goal_);
}

}  // namespace selfcal
