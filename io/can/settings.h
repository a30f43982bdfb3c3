// Encoders on a CAN bus, as CONFIG.yaml describes them.
//
// clang-format off
//   key              default    range            meaning
//   interface        required   1 to 15 chars    "can0"
//   sync             see below                   at this frame all joints take their positions:
//     id             0x80       a CAN id
//     extended       false                       its id has 29 bits
//     send_period    none       0.0005 to 1 s    the service itself sends SYNC; else it is silent
//   cycle            see below  1e-4 to 1 s      without sync: from a joint's frame to its next
//   window           0.005      1e-4 to 1 s      with sync: a joint's frame comes within it
//                    1.6 cycle  1 to 10 cycles   without: most between two frames of a joint
//   delay            0          0 to 0.1 s       from the taking of a position to the stamp
//   dbc              none                        file with the messages and signals named below
//   joints           required                    NAME: {where its count stands, one of:
//     id                        a CAN id         0x181 or 385, with
//       extended     false                       its id has 29 bits
//       byte         0          0 to 63          first byte, and
//       length       4          1 to 8           bytes; or
//       bit          none       0 to 511         first bit as DBC files have it, and
//       bits         required   1 to 64          number of bits
//       signed       true
//       endian       little     little, big
//     cia402                                     position actual value 0x6064 in a TPDO at its
//                                                predefined id:
//       node         required   1 to 127
//       tpdo         1          1 to 4
//       byte         0          0 to 4           first of its four bytes
//     message, signal                            names in the DBC file, with
//       unit         required   deg, rad, m,     of the physical value
//                               mm, counts
//                                                and what a count means:
//     counts_per_turn required  above 0          unless the DBC's unit says it
//     gear           1          above 0          turns of the counter for one of the joint
//     pitch          none       above 0 (m)      way of one turn behind the gear; a linear joint
//     zero           0          whole counts     reading of the joint's zero
//     sign           1          1, -1
//     wraps_at       none       2 to 2^48 counts the counter begins anew there; turns are added
//     speed          10         1e-3 to 1e4      rad/s or m/s: a faster count is a jump
//     fd             false                       FD frames
//   }
// clang-format on
//
// Without `sync` there must be `cycle`; but joints by `cia402` are taken with SYNC 0x80 unless
// `cycle` is there. With `wraps_at` the first count is taken in the turn nearest to the joint's
// zero: a joint that travels farther than half a turn of its counter must stand there at the start.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/can/map.h"
#include "io/can/timing.h"
#include "kinematics/description.h"
#include "kinematics/robot.h"

namespace selfcal {

struct CanSettings {
  std::string interface;
  CanMap map;
  CanTiming timing;
  double sync_send_period = 0;   ///< s; 0: nothing is ever written to the bus
  int receive_buffer = 1 << 20;  ///< bytes asked for; the kernel gives what it may
};

/// Reads the mapping; `joints` are those of the robot in the order of the samples, 1 to
/// kMostJoints, and `folder` the one that a DBC file's name is relative to. What is wrong goes to
/// `problems`.
CanSettings read_can_settings(const Node& node, const std::vector<Joint>& joints,
                              const std::filesystem::path& folder, Problems& problems);

}  // namespace selfcal
