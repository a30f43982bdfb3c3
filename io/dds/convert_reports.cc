// What the service tells and is told: plain structs and generated ones.

#include "io/dds/convert.h"

namespace selfcal {
namespace {

using borrowed::text;

dds::Time time_of_ms(std::int64_t unix_ms) { return time_of(unix_ms * kMillisecond); }
std::int64_t milliseconds(const dds::Time& time) { return nanoseconds(time) / kMillisecond; }

}  // namespace

dds::Time time_of(Nanoseconds t) {
  Nanoseconds whole = t / kSecond;
  if (t % kSecond < 0) --whole;
  return {.sec_ = static_cast<std::int32_t>(whole),
          .nanosec_ = static_cast<std::uint32_t>(t - whole * kSecond)};
}

dds::Header header_of(Nanoseconds stamp) {
  static const std::string kNoFrame;
  return {.stamp_ = time_of(stamp), .frame_id_ = text(kNoFrame)};
}

Nanoseconds nanoseconds(const dds::Time& time) { return time.sec_ * kSecond + time.nanosec_; }

dds::Status borrow(const StatusMessage& status) {
  return {.stamp_ = time_of_ms(status.unix_ms),
          .robot_ = text(status.robot),
          .model_hash_ = text(status.model_hash),
          .version_ = text(status.version),
          .state_ = text(status.state),
          .phase_ = text(status.phase),
          .hardware_ = text(status.hardware),
          .why_ = text(status.why),
          .session_ = status.session,
          .kind_ = text(status.kind),
          .active_ = text(status.active),
          .active_since_ = time_of_ms(status.active_since_ms),
          .candidate_ = status.candidate,
          .next_due_ = time_of_ms(status.next_due_ms),
          .temperature_ = status.temperature};
}

StatusMessage to_plain(const dds::Status& status) {
  return {.unix_ms = milliseconds(status.stamp_),
          .robot = status.robot_,
          .model_hash = status.model_hash_,
          .version = status.version_,
          .state = status.state_,
          .phase = status.phase_,
          .hardware = status.hardware_,
          .why = status.why_,
          .session = status.session_,
          .kind = status.kind_,
          .active = status.active_,
          .active_since_ms = milliseconds(status.active_since_),
          .candidate = status.candidate_,
          .next_due_ms = milliseconds(status.next_due_),
          .temperature = status.temperature_};
}

dds::Progress borrow(const ProgressMessage& progress) {
  return {.stamp_ = time_of_ms(progress.unix_ms),
          .robot_ = text(progress.robot),
          .session_ = progress.session,
          .kind_ = text(progress.kind),
          .done_ = progress.done,
          .planned_ = progress.planned,
          .put_aside_ = progress.outlier,
          .seconds_left_ = progress.seconds_left,
          .touch_set_ = text(progress.set),
          .touch_index_ = progress.index,
          .residual_ = progress.residual,
          .accepted_ = progress.accepted,
          .note_ = text(progress.note)};
}

ProgressMessage to_plain(const dds::Progress& progress) {
  return {.unix_ms = milliseconds(progress.stamp_),
          .robot = progress.robot_,
          .session = progress.session_,
          .kind = progress.kind_,
          .done = progress.done_,
          .planned = progress.planned_,
          .outlier = progress.put_aside_,
          .seconds_left = progress.seconds_left_,
          .set = progress.touch_set_,
          .index = progress.touch_index_,
          .residual = progress.residual_,
          .accepted = progress.accepted_,
          .note = progress.note_};
}

dds::Result borrow(const ResultMessage& result) {
  return {.stamp_ = time_of_ms(result.unix_ms),
          .robot_ = text(result.robot),
          .model_hash_ = text(result.model_hash),
          .session_ = result.session,
          .kind_ = text(result.kind),
          .answer_ = text(result.answer),
          .decision_ = text(result.decision),
          .why_ = text(result.why),
          .p_value_ = result.p_value,
          .check_before_ = result.check_before,
          .check_after_ = result.check_after,
          .endpoint_sigma_ = result.endpoint_sigma,
          .touches_ = result.touches,
          .rejected_ = result.outliers,
          .identified_ = result.identified,
          .json_ = text(result.json),
          .cause_ = text(result.cause),
          .cause_probability_ = result.cause_probability,
          .cause_closes_ = result.cause_closes};
}

ResultMessage to_plain(const dds::Result& result) {
  const ResultFigures figures{.p_value = result.p_value_,
                              .check_before = result.check_before_,
                              .check_after = result.check_after_,
                              .endpoint_sigma = result.endpoint_sigma_,
                              .touches = result.touches_,
                              .outliers = result.rejected_,
                              .identified = result.identified_};
  return {figures,
          milliseconds(result.stamp_),
          result.robot_,
          result.model_hash_,
          result.session_,
          result.kind_,
          result.answer_,
          result.decision_,
          result.why_,
          result.json_,
          result.cause_,
          result.cause_probability_,
          result.cause_closes_};
}

dds::Command borrow(const CommandMessage& command) {
  return {.id_ = text(command.id), .verb_ = text(command.verb), .from_ = text(command.from)};
}

CommandMessage to_plain(const dds::Command& command) {
  return {.id = command.id_, .verb = command.verb_, .from = command.from_};
}

dds::CommandReply borrow(const CommandReplyMessage& reply) {
  return {.id_ = text(reply.id),
          .verb_ = text(reply.verb),
          .accepted_ = reply.accepted,
          .why_ = text(reply.why)};
}

CommandReplyMessage to_plain(const dds::CommandReply& reply) {
  return {.id = reply.id_, .verb = reply.verb_, .accepted = reply.accepted_, .why = reply.why_};
}

}  // namespace selfcal
