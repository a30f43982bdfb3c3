// Who can reach a DDS participant of this process, by what CYCLONEDDS_URI says.
//
// The library takes a list of XML fragments and file:// addresses there, and of several interfaces
// uses all. Without any it chooses one by itself, which is a network's.
#pragma once

#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

struct DdsReach {
  bool loopback = false;  ///< every interface named is this computer's own
  bool secured = false;   ///< DDS Security is configured
};

/// Of a configuration's text. An interface counts as this computer's own by its name (lo) or
/// address (127.0.0.0/8, ::1).
DdsReach reach_of(std::string_view configuration);

/// Of CYCLONEDDS_URI, files that it names included; fails when one cannot be read.
Result<DdsReach> dds_reach();

}  // namespace selfcal
