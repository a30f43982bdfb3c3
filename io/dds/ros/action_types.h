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

using GoalStatusArray = ::action_msgs_msg_dds__GoalStatusArray_;
// As rmw_fastrtps has them on the wire.
using FastSendGoalRequest = ::selfcal_fast_SendGoalRequest;
using FastSendGoalReply = ::selfcal_fast_SendGoalReply;
using FastCancelRequest = ::selfcal_fast_CancelRequest;

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
template <>
inline constexpr MessageType message_type<GoalStatusArray>{
    &action_msgs_msg_dds__GoalStatusArray__desc, ""};

/// A type under the name of another, which has the same fields to those who read it.
inline dds_topic_descriptor_t named_as(const dds_topic_descriptor_t& other,
                                       dds_topic_descriptor_t type) {
  type.m_typename = other.m_typename;
  return type;
}
inline const dds_topic_descriptor_t kFastSendGoalRequest =
    named_as(*message_type<SendGoalRequest>.descriptor, selfcal_fast_SendGoalRequest_desc);
inline const dds_topic_descriptor_t kFastSendGoalReply =
    named_as(*message_type<SendGoalReply>.descriptor, selfcal_fast_SendGoalReply_desc);
inline const dds_topic_descriptor_t kFastCancelRequest =
    named_as(*message_type<CancelRequest>.descriptor, selfcal_fast_CancelRequest_desc);
template <>
inline constexpr MessageType message_type<FastSendGoalRequest>{&kFastSendGoalRequest, ""};
template <>
inline constexpr MessageType message_type<FastSendGoalReply>{&kFastSendGoalReply, ""};
template <>
inline constexpr MessageType message_type<FastCancelRequest>{&kFastCancelRequest, ""};

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
/// "rt/arm/follow_joint_trajectory/_action/status".
inline std::string action_status_topic(std::string action) {
  if (!action.starts_with("/")) action = "/" + action;
  return "rt" + action + "/_action/status";
}

}  // namespace selfcal
