// The parts of CONFIG.yaml that say how the robot moves and touches, and how long each may take.
#pragma once

#include "app/service/config/config.h"

namespace selfcal {

/// `motion`, of a configuration whose robot is read.
void read_motion(Fields& f, Config& c, Problems& problems);
/// `touch`: repeats, tolerance, attempts.
void read_touch(Fields& f, Config& c);
/// `limits`: the longest that each part of a session may take.
void read_limits(Fields& f, Limits& limits);

}  // namespace selfcal
