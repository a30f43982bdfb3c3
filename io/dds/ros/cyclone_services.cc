// An action's services in rmw_cyclonedds' encoding.
#include "io/dds/ros/cyclone_services.h"

#include <algorithm>

#include "io/dds/opened.h"

namespace selfcal {
namespace {

// action_msgs/msg/GoalStatus
constexpr int kSucceeded = 4, kCanceled = 5;

/// FollowJointTrajectory_Result's constants.
std::string error_name(std::int32_t code) {
  switch (code) {
    case 0:
      return "aborted";
    case -1:
      return "INVALID_GOAL";
    case -2:
      return "INVALID_JOINTS";
    case -3:
      return "OLD_HEADER_TIMESTAMP";
    case -4:
      return "PATH_TOLERANCE_VIOLATED";
    case -5:
      return "GOAL_TOLERANCE_VIOLATED";
    default:
      return "error " + std::to_string(code);
  }
}

GoalNews news_of(const dds::GetResultReply& reply, const GoalId& goal) {
  using What = GoalNews::What;
  if (reply.status_ == kSucceeded && reply.error_code_ == 0) return {goal, What::done, {}};
  if (reply.status_ == kCanceled) return {goal, What::cancelled, {}};
  std::string why = error_name(reply.error_code_);
  if (*reply.error_string_) why += std::string(": ") + reply.error_string_;
  return {goal, What::aborted, why};
}

}  // namespace

CycloneServices::CycloneServices(std::vector<std::string> joints, Endpoints endpoints)
    : joints_(std::move(joints)), dds_(std::move(endpoints)) {
  dds_get_instance_handle(dds_.send.handle(), &client_);
}

Result<std::unique_ptr<GoalServices>> CycloneServices::open(const DdsParticipant& participant,
                                                            const std::string& action,
                                                            std::vector<std::string> joints,
                                                            Wakeup& wakeup) {
  Endpoints all;
  DdsOpening opening(participant);
  const auto request = [&](auto& writer, const char* service) {
    opening.open(writer, action_request_topic(action, service), kExchange, &wakeup);
  };
  const auto reply = [&](auto& reader, const char* service) {
    opening.open(reader, action_reply_topic(action, service), kExchange, &wakeup);
  };
  request(all.send, "send_goal");
  reply(all.sent, "send_goal");
  request(all.ask, "get_result");
  reply(all.result, "get_result");
  request(all.cancel, "cancel_goal");
  reply(all.cancelled, "cancel_goal");
  return opening.finish([&] {
    return std::unique_ptr<GoalServices>(new CycloneServices(std::move(joints), std::move(all)));
  });
}

bool CycloneServices::connected() const {
  return dds_.send.matched() > 0 && dds_.sent.matched() > 0 && dds_.ask.matched() > 0 &&
         dds_.result.matched() > 0 && dds_.cancel.matched() > 0 && dds_.cancelled.matched() > 0 &&
         !other_encoding();
}

bool CycloneServices::other_encoding() const {
  return writers_by_vendor(dds_.sent.handle()).fast_dds > 0;
}

Result<void> CycloneServices::send(const GoalId& goal, const std::vector<TrajectoryPoint>& points) {
  dds::SendGoalRequest request{};
  request.client_ = client_;
  request.number_ = sent_ = ++number_;
  asked_ = 0;
  goal_ = goal;
  std::ranges::copy(goal, request.goal_id_);
  const BorrowedGoal borrowed(joints_, points);
  request.goal_ = borrowed.goal();
  return dds_.send.write(request);
}

Result<void> CycloneServices::cancel(const GoalId& goal) {
  dds::CancelRequest request{};
  request.client_ = client_;
  request.number_ = ++number_;
  std::ranges::copy(goal, request.goal_info_.goal_id_);
  return dds_.cancel.write(request);
}

Result<void> CycloneServices::ask_for_result() {
  dds::GetResultRequest request{};
  request.client_ = client_;
  request.number_ = asked_ = ++number_;
  std::ranges::copy(goal_, request.goal_id_);
  return dds_.ask.write(request);
}

Result<void> CycloneServices::take(std::vector<GoalNews>& out) {
  bool accepted = false;
  auto taken = dds_.sent.take([&](const dds::SendGoalReply& reply) {
    if (reply.client_ != client_ || reply.number_ != sent_) return;
    accepted = reply.accepted_;
    using What = GoalNews::What;
    out.push_back({goal_, reply.accepted_ ? What::accepted : What::rejected, {}});
  });
  if (!taken) return taken;
  if (accepted)
    if (auto asked = ask_for_result(); !asked) return asked;
  taken = dds_.result.take([&](const dds::GetResultReply& reply) {
    if (reply.client_ != client_ || asked_ == 0 || reply.number_ != asked_) return;
    asked_ = 0;
    out.push_back(news_of(reply, goal_));
  });
  if (!taken) return taken;
  return dds_.cancelled.take([](const dds::CancelReply&) {});  // the result tells what became of it
}

}  // namespace selfcal
