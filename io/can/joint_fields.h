// The fields of one joint's entry.
#pragma once

#include "io/can/dbc.h"
#include "io/can/map.h"
#include "kinematics/description.h"
#include "kinematics/parameter.h"

namespace selfcal {

/// A CAN id, decimal or 0x…; of 29 bits where `extended`.
CanId read_can_id(Fields& fields, CanId fallback);

/// Of a joint whose readings are of `quantity`. `dbc` may be null. `cia402` becomes true where the
/// joint is of that kind.
CanJoint read_can_joint(const Node& node, const std::string& name, Quantity quantity,
                        const Dbc* dbc, bool& cia402, Problems& problems);

}  // namespace selfcal
