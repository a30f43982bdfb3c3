// The numbers of a touch and of a plan, packed: a touch is some 60 bytes, not 300.
//
//   u    unsigned LEB128: 7 bits a byte, lowest first, the top bit says that more follow
//   z    a signed number as u, zig-zag: 0, -1, 1, -2, … → 0, 1, 2, 3, …
//   d    a double, 8 bytes, lowest first
//   s    a text: u length, bytes
//
//   stamps    z before.time, z edge - before.time, z after.time - before.time,
//             u before.joints, z counts…, u after.joints, z counts - before's…
//   labels    u steps, u names, s name…; per step: u set, u group (places among the names),
//             u check + 2 via_home + 4 places of the way + 512 slow + 1024 loaded, z index - place
//   postures  per step start, touch, end, each place of its way: u size, d…
//
// Differences are modulo 2^64, so that every number comes back. Counts beyond a sample's joints
// are not kept: they mean nothing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/store/store.h"

namespace selfcal {

std::string pack_stamps(const TouchRecord& touch);
/// Fills edge, before and after; false when `packed` is none of pack_stamps' making.
bool unpack_stamps(std::string_view packed, TouchRecord& touch);

std::string pack_labels(const std::vector<StepRecord>& plan);
bool unpack_labels(std::string_view packed, std::vector<StepRecord>& plan);

std::string pack_postures(const std::vector<StepRecord>& plan);
/// Fills the readings of a plan that has its labels.
bool unpack_postures(std::string_view packed, std::vector<StepRecord>& plan);

}  // namespace selfcal
