// Who can reach a DDS participant of this process, by what CYCLONEDDS_URI says.
//
// The library takes a list of XML fragments and files there, file:// before them or not, and of
// several interfaces uses all. Without any it chooses one by itself, which is a network's.
#pragma once

#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

struct DdsReach {
  bool loopback = false;   ///< every interface named is this computer's own
  bool secured = false;    ///< DDS Security has all that it needs
  std::string lacks = {};  ///< of DDS Security that is configured in part: what is missing
  std::string governance =
      {};  ///< the document that says what it asks of participants, as configured
};

/// Of a configuration's text, as it holds in `domain`. An interface counts as this computer's own
/// by its name (lo) or address (127.0.0.0/8, ::1). DDS Security is complete with the three elements
/// of <Authentication> and the three of <AccessControl>, none empty.
DdsReach reach_of(std::string_view configuration, int domain);

/// How a governance document (signed or not) lets strangers write `topic`; empty when it does not.
std::string admits_strangers(std::string_view governance, const std::string& topic);

/// Of CYCLONEDDS_URI, files that it names included, the governance too, which must keep strangers
/// from writing `topic`; fails when one cannot be read.
Result<DdsReach> dds_reach(int domain, const std::string& topic);

}  // namespace selfcal
