// Where each joint's count stands in the frames of a bus, and what a count means.
//
//   reading = (counts - zero) * step     (rad or m)
//
// Pure data and arithmetic: the same map reads the frames of a robot and writes those of a
// simulated one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/can/bits.h"
#include "io/can/frame.h"
#include "io/ports.h"

namespace selfcal {

/// One joint's count in the frames of one id.
struct CanJoint {
  std::string name;
  CanId id;
  bool fd = false;  ///< its frames are FD frames, and only they count
  BitField field;
  EncoderScale scale;
  std::int64_t wraps_at = 0;  ///< counts after which the counter begins anew; 0: never
  /// The joint's limits lie within half a turn of the counter to either side of its zero, so that a
  /// count alone tells where it is.
  bool within_one_turn = false;
  double most_speed = 10;  ///< rad/s or m/s: faster is a counter that jumps
};

/// The frames of one id and the joints in them.
struct CanMessage {
  CanId id;
  bool fd = false;
  int bytes = 0;            ///< a shorter payload is broken
  std::vector<int> joints;  ///< indices into CanMap::joints
};

struct CanMap {
  std::vector<CanJoint> joints;
  std::optional<CanId> sync;         ///< its frames begin a cycle; without: joints run freely
  std::vector<CanMessage> messages;  ///< made by `finish`

  /// Groups the joints by their ids. Nothing on success, else the sentence of what is wrong: FD and
  /// classic joints in frames of one id, a joint beyond its payload, a joint in the frames of SYNC.
  std::optional<std::string> finish();
  std::vector<EncoderScale> scales() const;
  /// Index of the message with the id, or -1.
  int find(const CanId& id) const;
};

/// "j1, j2 (0x181)"
std::string name_of(const CanMap& map, const CanMessage& message);

/// Whether the frame is what the map says of its message: FD or classic, and long enough.
bool well_formed(const CanMessage& message, const CanFrame& frame);

/// The joint's count as it stands in a well-formed frame of its message.
std::int64_t raw_counts(const CanJoint& joint, const CanFrame& frame);

/// The frame of the message with these counts, by joint of the map; what a field has no room for is
/// cut off as a counter does that begins anew.
CanFrame encode(const CanMap& map, const CanMessage& message,
                const std::vector<std::int64_t>& counts);

/// The nearest count to a reading (rad or m).
std::int64_t counts_of(const EncoderScale& scale, double reading);

}  // namespace selfcal
