// The fence as people write it in files.
#pragma once

#include "constraints/planning/fence.h"
#include "kinematics/description.h"

namespace selfcal {

/// Lists, or null: `keep_out`, of {min: [x, y, z], max: [x, y, z]} or {point: [x, y, z],
/// normal: [x, y, z]}, the normal pointing at the free side; and `capsules`, of {link: FRAME,
/// from: [x, y, z], to: [x, y, z], radius: R} in the frame, of a robot with statics.
Fence read_fence(const Node* keep_out, const Node* capsules, const Robot& robot,
                 Problems& problems);

}  // namespace selfcal
