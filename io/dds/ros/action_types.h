// The generated types of follow_joint_trajectory.idl, and what their topics are called.
//
// Services' types carry no hash: nothing compares it, and ROS 2 hashes a service as a whole.
#pragma once

#include <follow_joint_trajectory.h>

#include <string>

#include <selfcal_messages/types.h>

namespace selfcal::dds {

using SendGoalRequest = ::control_msgs_action_dds__FollowJointTrajectory_SendGoal_Request_;
using SendGoalReply = ::control_msgs_action_dds__FollowJointTrajectory_SendGoal_Response_;
using GetResultRequest = ::control_msgs_action_dds__FollowJointTrajectory_GetResult_Request_;
using GetResultReply = ::control_msgs_action_dds__FollowJointTrajectory_GetResult_Response_;
using CancelRequest = ::action_msgs_srv_dds__CancelGoal_Request_;
using CancelReply = ::action_msgs_srv_dds__CancelGoal_Response_;

template <>
inline constexpr MessageType message_type<SendGoalRequest>{
    &control_msgs_action_dds__FollowJointTrajectory_SendGoal_Request__desc, ""};
template <>
inline constexpr MessageType message_type<SendGoalReply>{
    &control_msgs_action_dds__FollowJointTrajectory_SendGoal_Response__desc, ""};
template <>
inline constexpr MessageType message_type<GetResultRequest>{
    &control_msgs_action_dds__FollowJointTrajectory_GetResult_Request__desc, ""};
template <>
inline constexpr MessageType message_type<GetResultReply>{
    &control_msgs_action_dds__FollowJointTrajectory_GetResult_Response__desc, ""};
template <>
inline constexpr MessageType message_type<CancelRequest>{
    &action_msgs_srv_dds__CancelGoal_Request__desc, ""};
template <>
inline constexpr MessageType message_type<CancelReply>{
    &action_msgs_srv_dds__CancelGoal_Response__desc, ""};

}  // namespace selfcal::dds

namespace selfcal {

/// "rq/arm/follow_joint_trajectory/_action/send_goalRequest" of `service` send_goal, get_result or
/// cancel_goal.
inline std::string action_request_topic(std::string action, const std::string& service) {
  if (!action.starts_with("/")) action = "/" + action;
  return "rq" + action + "/_action/" + service + "Request";
}
inline std::string action_reply_topic(std::string action, const std::string& service) {
  if (!action.starts_with("/")) action = "/" + action;
  return "rr" + action + "/_action/" + service + "Reply";
}

}  // namespace selfcal
