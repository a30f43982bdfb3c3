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
  if (!receive() || reader_.matched() == 0 || has_ceased()) return std::nullopt;
  return level_;
}

// Beyond the usual gaps: of a robot that is gone the joint states are missed first.
bool DdsTrigger::has_ceased() const {
  return repeats_ && monotonic_now() - heard_ > silence_ + 2 * longest_;
}

std::string DdsTrigger::trouble() const {
  if (!has_ceased()) return {};
  char text[80];
  std::snprintf(text, sizeof text, "its level, repeated before, has not come for %.2g s",
                seconds(silence_));
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
    const bool changed = level_ && *level_ != message.data_;
    note_level(message.data_, writer);
    if (!changed) return;
    if (waiting_.size() == kMostEdges) {
      waiting_.pop_front();
      ++overflowed_;
    }
    waiting_.push_back({.time = nanoseconds(message.header_.stamp_), .closed = message.data_});
  });
  // Who comes back may have another level: its first message is no edge.
  if (reader_.matched() == 0) level_.reset();
  return taken;
}

void DdsTrigger::note_level(bool closed, dds_instance_handle_t publisher) {
  const Nanoseconds now = monotonic_now();
  if (publisher != publisher_) {
    repeats_ = false;
    longest_ = 0;
  }
  if (publisher != publisher_ || closed != level_ || now - heard_ > silence_)
    same_since_ = now;
  else
    longest_ = std::max(longest_, now - heard_);
  repeats_ = repeats_ || now - same_since_ > silence_;
  publisher_ = publisher;
  heard_ = now;
  level_ = closed;
}

}  // namespace selfcal
