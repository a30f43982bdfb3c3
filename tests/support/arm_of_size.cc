#include "tests/support/arm_of_size.h"

#include <stdexcept>

#include "io/files/robot_file.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

std::unique_ptr<Robot> made(const std::string& text) {
  auto robot = robot_of(text, "machine");
  if (!robot) throw std::logic_error(robot.error().what);
  return std::move(*robot);
}

}  // namespace

std::unique_ptr<Robot> arm_of_size(double scale) {
  const auto length = [&](double m) { return format_number(scale * m); };
  const auto believed = [&](double m) {
    return ", tolerance: {d: " + length(m) + ", r: " + length(m) + "}}\n";
  };
  return made(
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: base, joint: fixed, theta: pi/2, r: " +
      length(0.5) + believed(50e-3) +
      "  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.79, 2.79]" + believed(2e-3) +
      "  - {name: j2, joint: revolute, alpha: -pi/2, limits: [-2.4, 2.4]" + believed(2e-3) +
      "  - {name: j3, joint: revolute, d: " + length(0.5) + ", limits: [-2.5, 2.5]" +
      believed(2e-3) + "  - {name: j4, joint: revolute, alpha: pi/2, r: " + length(0.5) +
      ", limits: [-4.7, 4.7]" + believed(2e-3) +
      "  - {name: j5, joint: revolute, alpha: -pi/2, limits: [-1.8, 2.1]" + believed(2e-3) +
      "  - {name: j6, joint: revolute, alpha: pi/2, r: " + length(0.3) + ", limits: [-4.7, 4.7]" +
      believed(2e-3) + "  - {name: tool, joint: fixed, alpha: 1.3, d: " + length(0.2) +
      ", theta: pi/2, r: " + length(0.1) + believed(50e-3));
}

std::unique_ptr<Robot> delta_of_size(double scale) {
  const auto m = [&](double length) { return format_number(scale * length); };
  std::string text =
      "robot: printer\nkind: linear-delta\ntool: [0.0, 0.0, " + m(-0.02) + "]\ntowers:\n";
  for (const double angle : {3.6652, 5.7596, 1.5708})
    text += "  - {radius: " + m(0.105) + ", angle: " + format_number(angle) +
            ", rod: " + m(0.2153) + ", endstop: " + m(0.4821) + ", limits: [" + m(-0.35) +
            ", 0], tolerance: {radius: " + m(2e-3) + ", rod: " + m(2e-3) + ", endstop: " + m(2e-3) +
            "}}\n";
  return made(text);
}

}  // namespace selfcal
