// A touch without a stamp as the service's trigger.
#include "app/bridge/touch_relay.h"

#include "io/dds/names.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kRepeatLevel = kSecond / 10;
// Reliable, as ROS publishes by default: a touch is told once, and none may be lost.
constexpr DdsQos kTouch{.depth = 64};

}  // namespace

Result<std::unique_ptr<TouchRelay>> TouchRelay::open(const DdsParticipant& participant,
                                                     const std::string& topic,
                                                     std::unique_ptr<TriggerSender> trigger,
                                                     Wakeup& wakeup) {
  auto reader = DdsReader<dds::Bool>::open(participant, ros_topic(topic), kTouch, &wakeup);
  if (!reader) return tl::unexpected(reader.error());
  return std::unique_ptr<TouchRelay>(new TouchRelay(*std::move(reader), std::move(trigger)));
}

Result<void> TouchRelay::turn(Nanoseconds now) {
  writer_.look(reader_);
  Result<void> sent;
  const auto taken = reader_.take([&](const dds::Bool& message, const dds_sample_info_t& info) {
    if (!sent || !writer_.believes(info.publication_handle, reader_)) return;
    const bool repeated = level_.level() == message.data_;
    level_.hear(message.data_, info.publication_handle, now);
    if (repeated) return;
    changed_ = info.source_timestamp;
    repeated_ = now;
    sent = trigger_->send(changed_, message.data_);
  });
  if (!taken) return taken;
  if (!sent) return sent;
  if (reader_.matched() == 0) level_.forget();
  const auto level = level_.level();
  if (!level || level_.has_ceased(now) || now - repeated_ < kRepeatLevel) return {};
  repeated_ = now;
  return trigger_->send(changed_, *level);
}

}  // namespace selfcal
