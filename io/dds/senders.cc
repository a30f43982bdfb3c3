// A robot's joint states and trigger level as topics.

#include "io/dds/senders.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"

namespace selfcal {

Result<std::unique_ptr<DdsJointSender>> DdsJointSender::open(const DdsParticipant& participant,
                                                             const std::string& topic,
                                                             std::vector<std::string> joints,
                                                             Wakeup& wakeup) {
  auto writer =
      DdsWriter<dds::JointState>::open(participant, ros_topic(topic), kSensorWriter, &wakeup);
  if (!writer) return tl::make_unexpected(writer.error());
  return std::unique_ptr<DdsJointSender>(new DdsJointSender(std::move(joints), *std::move(writer)));
}

DdsJointSender::DdsJointSender(std::vector<std::string> joints, DdsWriter<dds::JointState> writer)
    : joints_(std::move(joints)), writer_(std::move(writer)) {
  for (const auto& joint : joints_) names_.push_back(borrowed::text(joint));
}

Result<void> DdsJointSender::send(Nanoseconds stamp, const std::vector<double>& q) {
  const auto names = static_cast<std::uint32_t>(names_.size());
  const auto positions = static_cast<std::uint32_t>(q.size());
  return writer_.write({.header_ = header_of(stamp),
                        .name_ = {names, names, names_.data(), false},
                        .position_ = {positions, positions, const_cast<double*>(q.data()), false},
                        .velocity_ = {},
                        .effort_ = {}});
}

Result<std::unique_ptr<DdsTriggerSender>> DdsTriggerSender::open(const DdsParticipant& participant,
                                                                 const std::string& topic,
                                                                 Wakeup& wakeup) {
  auto writer =
      DdsWriter<dds::StampedBool>::open(participant, ros_topic(topic), kSensorWriter, &wakeup);
  if (!writer) return tl::make_unexpected(writer.error());
  return std::unique_ptr<DdsTriggerSender>(new DdsTriggerSender(*std::move(writer)));
}

Result<void> DdsTriggerSender::send(Nanoseconds stamp, bool closed) {
  return writer_.write({.header_ = header_of(stamp), .data_ = closed});
}

}  // namespace selfcal
