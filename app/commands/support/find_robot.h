// Which service a command means when the person names no robot.
#pragma once

#include <optional>
#include <string>

#include "app/commands/subcommand.h"
#include "io/dds/participant.h"
#include "io/ports.h"

namespace selfcal {

/// What `monitor` and `command` have in common.
struct Whom {
  std::string robot;  ///< empty: the only one in the domain
  int domain = 0;
  double wait = 5;  ///< s
  bool json = false;
};

void add_whom(CLI::App& command, Whom& whom, const std::string& what_waits);

/// The robot that `whom` names, or the only one that is heard before the wait is over. Fails when
/// there is none (kDeviceIsBad) or more than one (kWrongUsage, naming them). Nothing when told to
/// stop in the meantime.
Result<std::optional<std::string>> find_robot(const DdsParticipant& participant, const Whom& whom);

}  // namespace selfcal
