// A trajectory controller of ROS 2, faked: serves the action as rmw_cyclonedds would, and tells
// what it was asked; what it answers is the test's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dds/convert.h"
#include "io/dds/opened.h"
#include "io/dds/ros/trajectory_action.h"
#include "tests/support/domain.h"

namespace selfcal {

class FakeController {
 public:
  struct Call {
    std::uint64_t client = 0;
    std::int64_t number = 0;
    GoalId goal{};
  };
  struct Sent : Call {
    std::vector<std::string> joints;
    std::vector<TrajectoryPoint> points;
  };

  FakeController(const DdsParticipant& participant, const std::string& action, Wakeup& wakeup) {
    DdsOpening opening(participant);
    opening.open(send_, action_request_topic(action, "send_goal"), kExchange, &wakeup);
    opening.open(sent_, action_reply_topic(action, "send_goal"), kExchange, &wakeup);
    opening.open(ask_, action_request_topic(action, "get_result"), kExchange, &wakeup);
    opening.open(result_, action_reply_topic(action, "get_result"), kExchange, &wakeup);
    opening.open(cancel_, action_request_topic(action, "cancel_goal"), kExchange, &wakeup);
    opening.open(cancelled_, action_reply_topic(action, "cancel_goal"), kExchange, &wakeup);
    must(opening.finish([] { return 0; }));
  }

  /// Appends what was asked since the last call to the lists.
  void hear() {
    must(send_.take([&](const dds::SendGoalRequest& r) {
      Sent sent;
      sent.client = r.client_;
      sent.number = r.number_;
      std::ranges::copy(r.goal_id_, sent.goal.begin());
      const auto& trajectory = r.goal_.trajectory_;
      for (std::uint32_t j = 0; j < trajectory.joint_names_._length; ++j)
        sent.joints.emplace_back(trajectory.joint_names_._buffer[j]);
      for (std::uint32_t i = 0; i < trajectory.points_._length; ++i) {
        const auto& p = trajectory.points_._buffer[i];
        sent.points.push_back(
            {p.time_from_start_.sec_ + 1e-9 * p.time_from_start_.nanosec_,
             {p.positions_._buffer, p.positions_._buffer + p.positions_._length},
             {p.velocities_._buffer, p.velocities_._buffer + p.velocities_._length}});
      }
      goals.push_back(std::move(sent));
    }));
    must(ask_.take([&](const dds::GetResultRequest& r) {
      asked.push_back(call(r.client_, r.number_, r.goal_id_));
    }));
    must(cancel_.take([&](const dds::CancelRequest& r) {
      cancels.push_back(call(r.client_, r.number_, r.goal_info_.goal_id_));
    }));
  }
  void accept(const Call& call, bool yes = true) {
    must(sent_.write(
        {.client_ = call.client, .number_ = call.number, .accepted_ = yes, .stamp_ = {}}));
  }
  /// `status` of action_msgs/GoalStatus: 4 succeeded, 5 cancelled, 6 aborted.
  void finish(const Call& call, int status, int error = 0, const std::string& text = {}) {
    must(result_.write({.client_ = call.client,
                        .number_ = call.number,
                        .status_ = static_cast<std::int8_t>(status),
                        .error_code_ = error,
                        .error_string_ = borrowed::text(text)}));
  }
  void confirm_cancel(const Call& call) {
    must(cancelled_.write({.client_ = call.client,
                           .number_ = call.number,
                           .return_code_ = 0,
                           .goals_canceling_ = {}}));
  }

  std::vector<Sent> goals;
  std::vector<Call> asked, cancels;

 private:
  static Call call(std::uint64_t client, std::int64_t number, const std::uint8_t (&goal)[16]) {
    Call made{client, number, {}};
    std::ranges::copy(goal, made.goal.begin());
    return made;
  }
  DdsReader<dds::SendGoalRequest> send_;
  DdsWriter<dds::SendGoalReply> sent_;
  DdsReader<dds::GetResultRequest> ask_;
  DdsWriter<dds::GetResultReply> result_;
  DdsReader<dds::CancelRequest> cancel_;
  DdsWriter<dds::CancelReply> cancelled_;
};

}  // namespace selfcal
