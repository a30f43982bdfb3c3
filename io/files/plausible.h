// Rules that catch a wrong unit in the rows before it becomes a wrong robot.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "kinematics/robot.h"

namespace selfcal {

/// Why `value` (m) is no place or distance in a workshop; nothing when it may be.
std::optional<std::string> metres_fault(double value);

/// Why `value` (degrees Celsius) is no temperature of a robot at work; nothing when it may be.
std::optional<std::string> celsius_fault(double value);

/// A question where `temperatures` (degrees Celsius; NaN: none) are warm for a robot and usual for
/// a room in Fahrenheit; nothing else.
std::optional<std::string> celsius_doubt(const Eigen::VectorXd& temperatures);

/// What readings may be: such as the joints' limits allow; or any, where what is wrong with them is
/// to be found out.
enum class Readings { within_limits, any };

/// Why `reading` cannot be one of the joint: many turns, or beyond the limits by more than a tenth
/// of their range. Readings a little beyond are common and allowed.
std::optional<std::string> joint_fault(const Joint& joint, double reading,
                                       Readings readings = Readings::within_limits);

/// True when the reading is beyond the limits by more than their rounding.
bool outside_limits(const Joint& joint, double reading);

/// How far the length of a quaternion may be from 1 (digits lost in the file), and that of a normal
/// (each component measured).
inline constexpr double kQuaternionTolerance = 1e-3;
inline constexpr double kNormalTolerance = 0.05;

/// Scales `vector` to length 1. A length further than `tolerance` from 1 is a fault, in which
/// `what` names the vector.
std::optional<std::string> make_unit(std::span<double> vector, double tolerance,
                                     const std::string& what);

}  // namespace selfcal
