// The frames of a serial robot's file: one read, one written, a standard DH table turned into ours.
#pragma once

#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {

/// How the four numbers of a frame are meant (`convention` in the file).
enum class Convention { modified, standard };

/// One entry of `frames`, the `index`-th. `based`: before the first joint, where a fixed frame
/// places the robot in its world. In the standard convention the numbers are those of the table.
Frame read_frame(const Node& node, int index, Convention convention, bool based,
                 Problems& problems);

Node write_frame(const Frame& frame);

/// The frames of a standard DH table, in which row j goes from frame j-1 to frame j by
///   T = Rot(z, theta) Trans(z, r) Trans(x, d) Rot(x, alpha)
/// regrouped: alpha and d of a row belong to the frame after it, with their tolerances; what the
/// last row leaves, unless it is nothing, is a fixed frame of its own. Whole poses stay. Centres of
/// masses are turned into the frames that carry them.
std::vector<Frame> from_standard(const std::vector<Frame>& table);

}  // namespace selfcal::serial
