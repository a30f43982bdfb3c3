// A robot of each kind, as its file is written; the contracts walk them.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace selfcal {

inline const std::map<std::string_view, std::string>& kind_examples() {
  static const std::map<std::string_view, std::string> examples = {
      {"serial", R"(robot: arm
kind: serial
frames:
  - {name: base, joint: fixed, alpha: 0.1, d: 0.2, theta: 0.3, r: 0.4, beta: 0.05}
  - {name: j1, joint: revolute, alpha: 0.02, r: 0.3, limits: [-2.5, 2.5]}
  - {name: j2, joint: revolute, alpha: -1.5, d: 0.15, gear: 1.01, limits: [-1.5, 1.5]}
  - {name: j3, joint: prismatic, alpha: 1.4, d: 0.1, r: 0.5, limits: [-0.1, 0.3]}
  - {name: tool, joint: fixed, d: 0.03, r: 0.12, theta: 0.4, tolerance: {d: 1.0e-3}}
coupling: [[1, 0, 0], [0.2, 1, 0], [0, 0, 1]]
)"},
      {"linear-delta", R"(robot: printer
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.6652, rod: 0.2153, endstop: 0.4821, tilt: [0.01, -0.02], limits: [-0.35, 0]}
  - {radius: 0.104, angle: 5.7596, rod: 0.2161, endstop: 0.4813, scale: 1.001, limits: [-0.35, 0]}
  - {radius: 0.106, angle: 1.5708, rod: 0.2149, endstop: 0.4826, limits: [-0.35, 0], tolerance: {rod: 5.0e-4}}
effector: {rx: 0.01, ry: -0.015}
tool: [0.004, -0.003, -0.02]
)"}};
  return examples;
}

}  // namespace selfcal
