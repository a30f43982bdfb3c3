// Where each joint's count stands in the frames of a bus.

#include "io/can/map.h"

#include <algorithm>
#include <cmath>

namespace selfcal {

std::optional<std::string> CanMap::finish() {
  messages.clear();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const CanJoint& joint = joints[j];
    const int bytes = bytes_of(joint.field);
    if (bytes > (joint.fd ? 64 : 8))
      return "joint " + joint.name + " stands beyond the payload of its frames";
    if (sync && joint.id == *sync) return "joint " + joint.name + " has the id of SYNC";
    int index = find(joint.id);
    if (index < 0) {
      index = static_cast<int>(messages.size());
      messages.push_back({.id = joint.id, .fd = joint.fd, .bytes = 0, .joints = {}});
    }
    CanMessage& message = messages[index];
    if (message.fd != joint.fd)
      return "joint " + joint.name + ": frames of one id are all FD or all classic";
    message.bytes = std::max(message.bytes, bytes);
    message.joints.push_back(static_cast<int>(j));
  }
  return std::nullopt;
}

std::vector<EncoderScale> CanMap::scales() const {
  std::vector<EncoderScale> scales;
  for (const CanJoint& joint : joints) scales.push_back(joint.scale);
  return scales;
}

int CanMap::find(const CanId& id) const {
  const auto found = std::ranges::find(messages, id, &CanMessage::id);
  return found == messages.end() ? -1 : static_cast<int>(found - messages.begin());
}

std::string name_of(const CanMap& map, const CanMessage& message) {
  std::string names;
  for (const int j : message.joints) names += (names.empty() ? "" : ", ") + map.joints[j].name;
  return names + " (" + to_string(message.id) + ")";
}

bool well_formed(const CanMessage& message, const CanFrame& frame) {
  return frame.fd == message.fd && frame.size >= message.bytes;
}

std::int64_t raw_counts(const CanJoint& joint, const CanFrame& frame) {
  return get_bits(joint.field, {frame.data.data(), frame.size});
}

CanFrame encode(const CanMap& map, const CanMessage& message,
                const std::vector<std::int64_t>& counts) {
  CanFrame frame;
  frame.id = message.id;
  frame.fd = message.fd;
  frame.size = payload_size(message.bytes, message.fd);
  for (const int j : message.joints) {
    const CanJoint& joint = map.joints[j];
    std::int64_t value = counts[j];
    // A counter of n steps reads 0 to n - 1; a signed field holds them about zero.
    if (joint.wraps_at > 0) {
      value = ((value % joint.wraps_at) + joint.wraps_at) % joint.wraps_at;
      if (joint.field.is_signed && value >= (joint.wraps_at + 1) / 2) value -= joint.wraps_at;
    }
    put_bits(joint.field, value, frame.data);
  }
  return frame;
}

std::int64_t counts_of(const EncoderScale& scale, double reading) {
  return scale.zero + std::llround(reading / scale.step);
}

}  // namespace selfcal
