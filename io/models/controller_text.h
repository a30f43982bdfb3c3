// A serial robot as controllers are told of it that take no more than joint offsets with base and
// tool frames, or a table of Denavit and Hartenberg's numbers; each with the maker's to undo it.
#pragma once

#include <string>
#include <vector>

#include "io/result.h"
#include "kinematics/robots/serial.h"

namespace selfcal {

/// The lines of `text` behind comment signs; the last one ends.
std::string commented(const std::string& text, char sign = '#');

/// What stands behind the robot's last joint, and what to put behind a tool frame that is set by
/// the maker's figures: TOOL times this.
struct ToolFrame {
  Eigen::Isometry3d pose, nominal;  ///< in the last joint's frame
  Eigen::Isometry3d correction() const { return nominal.inverse() * pose; }
};
ToolFrame tool_frame(const serial::Model& robot);

/// "x y z 1 2 3 mm, roll pitch yaw 1 2 3 degrees".
std::string pose_in_words(const Eigen::Isometry3d& X);

/// YAML: what to add to the joints' positions, the robot's pose in the world, the tool in the last
/// joint's frame; the same before the calibration under `undo`. `head` says what it is, in lines.
std::string controller_offsets_text(const serial::Model& robot, const std::string& head);

/// The table that read_dh_table reads, in `convention`, a row a frame from the first joint to the
/// last, behind comment lines with `head`, the frames of base and tool and the same of `before`,
/// which undoes it. Refuses (`file` in the message) a robot with a whole pose between its joints.
/// beta is not in it.
Result<std::string> dh_table_text(const serial::Model& robot, const serial::Model& before,
                                  const std::string& convention, const std::string& head,
                                  const std::string& file);

}  // namespace selfcal
