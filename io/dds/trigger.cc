// The touch trigger from a topic of stamped levels.

#include "io/dds/trigger.h"

#include <cstdio>

#include "io/dds/convert.h"
#include "io/dds/names.h"

namespace selfcal {

Result<std::unique_ptr<DdsTrigger>> DdsTrigger::open(const DdsParticipant& participant,
                                                     const DdsTriggerConfig& config,
                                                     std::shared_ptr<TimeMapping> mapping,
                                                     Wakeup& wakeup) {
  auto reader = DdsReader<dds::StampedBool>::open(participant, ros_topic(config.topic),
                                                  kSensorReader, &wakeup);
  if (!reader) return tl::make_unexpected(reader.error());
  return std::unique_ptr<DdsTrigger>(
      new DdsTrigger(std::move(mapping), *std::move(reader), config.silence));
}

std::optional<bool> DdsTrigger::closed() {
  if (!receive() || reader_.matched() == 0 || level_.has_ceased(monotonic_now()))
    return std::nullopt;
  return level_.level();
}

std::string DdsTrigger::trouble() const {
  if (!level_.has_ceased(monotonic_now())) return {};
  char text[80];
  std::snprintf(text, sizeof text, "its level, repeated before, has not come for %.2g s",
                seconds(level_.silence()));
  return text;
}

Result<void> DdsTrigger::take(std::vector<Edge>& out) {
  if (auto received = receive(); !received) return received;
  for (std::size_t i = 0; i < kMostEdges && !waiting_.empty(); ++i) {
    const auto time = mapping_->ours(waiting_.front().time);
    if (!time) break;
    out.push_back({.time = *time, .closed = waiting_.front().closed});
    waiting_.pop_front();
  }
  return {};
}

Result<void> DdsTrigger::receive() {
  writer_.look(reader_);
  auto taken = reader_.take([&](const dds::StampedBool& message, dds_instance_handle_t writer) {
    if (!writer_.believes(writer, reader_)) return;
    const bool changed = level_.level() && level_.level() != message.data_;
    level_.hear(message.data_, writer, monotonic_now());
    if (!changed) return;
    if (waiting_.size() == kMostEdges) {
      waiting_.pop_front();
      ++overflowed_;
    }
    waiting_.push_back({.time = nanoseconds(message.header_.stamp_), .closed = message.data_});
  });
  // Who comes back may have another level: its first message is no edge.
  if (reader_.matched() == 0) level_.forget();
  return taken;
}

}  // namespace selfcal
