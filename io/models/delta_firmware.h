// A linear delta as the firmwares of printers are told of it: M665 and M666 of RepRapFirmware and,
// with other meanings, of Marlin, and Klipper's printer.cfg; each with the maker's figures to undo
// it. What the numbers mean there is in kinematics/robots/README.md.
#pragma once

#include <string>
#include <vector>

#include "io/result.h"
#include "kinematics/inverse/controller_fit.h"
#include "kinematics/robots/linear_delta.h"

namespace selfcal {

struct FirmwareText {
  std::string text;
  std::vector<std::string> left_out;  ///< what a firmware does not hold, with its size
};

/// What firmwares hold of a delta: one radius of all towers, and of each its angle, rod and
/// endstop. Its scales, which the steps per mm are divided by, and the tool are given.
ControllerNumbers firmware_numbers(const linear_delta::Delta& delta);
/// What a firmware holds of the maker's figures, the steps per mm too.
Eigen::VectorXd makers_firmware_numbers(const linear_delta::Delta& delta);

/// The lines of the values `told`, of firmware_numbers, behind `head` in comments. Refuses towers
/// that do not stand near 210, 330 and 90 degrees in this order, as firmwares have them; `file`
/// stands for the robot's. Lengths are mm, angles degrees there, heights those of the tool.
Result<FirmwareText> delta_firmware(const linear_delta::Delta& delta, const Eigen::VectorXd& told,
                                    const std::string& head, const std::string& file);

}  // namespace selfcal
