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
)"},
      {"gough-stewart", R"(robot: hexapod
kind: gough-stewart
legs:
  - {base: [0.5921, -0.1055, 0.0064], platform: [0.2291, -0.2577, -0.0013], offset: 0.01, limits: [0.55, 1.15]}
  - {base: [0.5919, 0.0988, 0.0036], platform: [0.2386, 0.2615, 0.0035], limits: [0.55, 1.15], swing: [0.6, 0.7]}
  - {base: [-0.1922, 0.5733, -0.007], platform: [0.1287, 0.3298, -0.0074], limits: [0.55, 1.15], tolerance: {bx: 5.0e-4, offset: 1.0e-3}}
  - {base: [-0.3983, 0.4534, 0.0004], platform: [-0.3539, 0.0562, 0.0022], limits: [0.55, 1.15]}
  - {base: [-0.4089, -0.4618, -0.0125], platform: [-0.3548, -0.0629, -0.0016], limits: [0.55, 1.15]}
  - {base: [-0.2125, -0.5693, -0.0032], platform: [0.1251, -0.3267, 0.0036], offset: -0.005, limits: [0.55, 1.15]}
home: {xyz: [0, 0, 0.7], rpy: [0, 0, 0.05]}
)"},
      {"hexaslide", R"(robot: slider
kind: hexaslide
chains:
  - {rail_start: [-0.7359, -0.5522, 0.2614], rail_direction: [0.7502, 0.4332], platform: [-0.0611, -0.1617, -0.0161], length: 0.9947}
  - {rail_start: [-0.8418, -0.3589, 0.2599], rail_direction: [0.7498, 0.4327], platform: [-0.1708, 0.0288, -0.0162], length: 0.9948, tolerance: {length: 1.0e-3, ax: 5.0e-4}}
  - {rail_start: [-0.1101, 0.8991, 0.2534], rail_direction: [0.0002, -0.8662], platform: [-0.1102, 0.1371, -0.0161], length: 0.9946}
  - {rail_start: [0.1102, 0.8972, 0.2518], rail_direction: [-0.0002, -0.8663], platform: [0.1098, 0.1372, -0.0158], length: 0.9947, limits: [0, 0.9], swing: [0.9, 0.9]}
  - {rail_start: [0.8397, -0.3556, 0.2563], rail_direction: [-0.7497, 0.4329], platform: [0.1738, 0.0288, -0.0161], length: 0.9948}
  - {rail_start: [0.7297, -0.5463, 0.2539], rail_direction: [-0.7503, 0.4327], platform: [0.0637, -0.1617, -0.0162], length: 0.9947}
)"}};
  return examples;
}

/// What the file of each says of its weight; to be added to the example.
inline const std::map<std::string_view, std::string>& kind_masses() {
  static const std::map<std::string_view, std::string> masses = {
      {"serial", "mass: 40\npayload: 5\n"},
      {"linear-delta",
       "gravity: [0.3, 0, -9.8]\n"
       "masses: {effector: 0.2, com: [0, 0.01, -0.02], carriages: 0.15, rods: 0.06}\n"},
      {"gough-stewart",
       "masses: {platform: 15, com: [0.01, 0, 0.05], cylinders: 4, cylinder_com: 0.2, pistons: 2, "
       "piston_com: 0.15}\n"},
      {"hexaslide", "masses: {platform: 8, com: [0, 0.01, -0.03], carriages: 2, links: 1}\n"}};
  return masses;
}

}  // namespace selfcal
