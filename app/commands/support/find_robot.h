// Which service a command means when the person names no robot.
#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// The robot that `whom` names, or all that are heard before the wait is over, as they stand in
/// topics; fails when there is none (kDeviceIsBad). Nothing when told to stop in the meantime.
Result<std::optional<std::vector<std::string>>> find_robots(const DdsParticipant& participant,
                                                            const Whom& whom);

/// The only one of these; fails when there are more (kWrongUsage, naming them).
Result<std::optional<std::string>> find_robot(const DdsParticipant& participant, const Whom& whom);

}  // namespace selfcal
