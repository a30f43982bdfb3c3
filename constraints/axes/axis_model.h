// A nominal robot from circle points alone: the axes of its joints, and the frames that follow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "constraints/axes/turn_axis.h"
#include "constraints/methods/data_set.h"
#include "kinematics/robots/serial.h"

namespace selfcal {

/// The axis of one joint in the world, all joints at zero.
struct JointAxis {
  std::string joint;
  TurnAxis line;
};

struct AxisModel {
  serial::Model found;  ///< what the axes say; the joints' names, limits and couplings of the file
  serial::Model made;   ///< the robot of the file in frames of the same kind, to compare with
  std::vector<JointAxis> axes;  ///< by joint
};

/// True where the sets say the axes of joints and nothing else.
bool of_circles_alone(const DataSet& data);

/// The robot that the `fit` rows of circle-point sets say, `file` being the serial robot of its
/// file: its joints, couplings and gear ratios are believed, its lengths and angles are not. Where
/// joint 1 and the last joint have their zero, how far along its axis each frame stands, and the
/// tool behind, no axis tells: they are the file's. Nothing after a problem, which names its set.
std::optional<AxisModel> axis_model(const serial::Model& file, const DataSet& data,
                                    std::vector<std::string>& problems);

/// Most that another joint's variable may move while one turns (rad or m).
inline constexpr double kStands = 1e-4;

}  // namespace selfcal
