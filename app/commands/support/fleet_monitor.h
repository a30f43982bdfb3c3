// selfcal monitor of a domain with several robots: all of them.
#pragma once

#include "app/commands/support/find_robot.h"
#include "io/dds/participant.h"

namespace selfcal {

/// A table, the robot that needs a person most first: live on a terminal, `once` elsewhere; without
/// either what each robot tells, a line a message. Returns the exit status.
int monitor_fleet(const DdsParticipant& participant, bool once, const Whom& whom);

}  // namespace selfcal
