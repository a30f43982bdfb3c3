// Two joints on a bus, and frames of them.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "io/can/assembler.h"

namespace selfcal {

/// Joints a (0x181) and b (0x182) as 32-bit counts at byte 0, 1 urad each; with SYNC 0x80 or not.
inline CanMap two_joints(bool sync) {
  CanMap map;
  if (sync) map.sync = CanId{.value = 0x80, .extended = false};
  for (const char* name : {"a", "b"}) {
    CanJoint joint;
    joint.name = name;
    joint.id.value = 0x181 + static_cast<std::uint32_t>(map.joints.size());
    joint.field = byte_field(0, 4, false, true);
    joint.scale.step = 1e-6;
    joint.most_speed = 10;
    map.joints.push_back(joint);
  }
  EXPECT_EQ(map.finish(), std::nullopt);
  return map;
}

inline CanFrame sync_frame() {
  CanFrame frame;
  frame.id.value = 0x80;
  return frame;
}

/// An assembler and what came out of it. Times in microseconds.
struct Bus {
  explicit Bus(CanMap the_map, const CanTiming& timing)
      : map(std::move(the_map)), assembler(map, timing, faults) {}

  void frame(int joint, std::int64_t counts, double t_us) {
    std::vector<std::int64_t> all(map.joints.size(), counts);
    add(encode(map, map.messages[joint], all), t_us);
  }
  void sync(double t_us) { add(sync_frame(), t_us); }
  void add(const CanFrame& frame, double t_us) {
    assembler.add(frame, static_cast<Nanoseconds>(t_us * 1e3), samples);
  }
  std::uint64_t count(CanFault fault) const { return faults.count(fault); }
  /// Faults of all kinds but these.
  std::uint64_t others(std::initializer_list<CanFault> known) const {
    std::uint64_t sum = 0;
    for (int i = 0; i < kCanFaults; ++i) {
      const auto fault = static_cast<CanFault>(i);
      if (std::find(known.begin(), known.end(), fault) == known.end()) sum += faults.count(fault);
    }
    return sum;
  }
  std::string trouble(double t_us) const {
    return faults.trouble(static_cast<Nanoseconds>(t_us * 1e3));
  }

  CanMap map;
  CanFaults faults{"can0"};
  CanAssembler assembler;
  std::vector<EncoderSample> samples;
};

}  // namespace selfcal
