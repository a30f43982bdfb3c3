// The RX-90 of the chapter's tables, true ones drawn about it, and the planes that they touch.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/files/yaml.h"
#include "kinematics/make_robot.h"
#include "tests/recovery/session.h"

namespace selfcal::recovery {

inline constexpr const char* kRx90 = R"(
robot: staubli-rx90
kind: serial
frames:
  - {name: base, joint: fixed, theta: 1.5707963267948966, r: 0.5}
  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.79, 2.79]}
  - {name: j2, joint: revolute, alpha: -1.5707963267948966, limits: [-2.40, 2.40]}
  - {name: j3, joint: revolute, d: 0.5, limits: [-2.49, 2.49]}
  - {name: j4, joint: revolute, alpha: 1.5707963267948966, r: 0.5, limits: [-4.71, 4.71]}
  - {name: j5, joint: revolute, alpha: -1.5707963267948966, limits: [-1.83, 2.09]}
  - {name: j6, joint: revolute, alpha: 1.5707963267948966, r: 0.3, limits: [-4.71, 4.71]}
  - {name: tool, joint: fixed, alpha: 1.3, d: 0.2, theta: 1.5707963267948966, r: 0.1}
)";

inline std::unique_ptr<Robot> robot_of(const std::string& text) {
  Problems problems;
  const auto node = parse_yaml(text, "robot");
  return make_robot(*node, problems);
}

/// Errors of 1 mm and 1 mrad, 5 mm and 5 mrad of base and tool; r4, the longest link, exact on
/// demand. `times` as much of the links: 2 is what their maker says.
inline Eigen::VectorXd rx90_truth(const Robot& robot, Random& random, bool exact_r4,
                                  double times = 1) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = nominal_values(robot);
  for (size_t i = 0; i < robot.parameters().size(); ++i) {
    const Parameter& p = robot.parameters()[i];
    const double sigma = p.part == Part::gear ? 0 : p.part == Part::link ? times * 1e-3 : 5e-3;
    if (!(exact_r4 && p.name == "r4")) xi[static_cast<Eigen::Index>(i)] += sigma * normal(random);
  }
  return xi;
}

inline std::vector<SetPart> four_planes(int rows) {
  std::vector<SetPart> parts;
  for (const char* name : {"a", "b", "c", "d"})
    parts.push_back({name, entry({{"method", "plane"}}), rows});
  return parts;
}

/// A step of 200 mm from plane a.
inline SetPart step_of_a(int rows) {
  Node gauge = entry({{"method", "plane"}});
  gauge.set("parallel_to", entry({{"set", "a"}, {"distance", "0.2"}, {"noise", "2e-6"}}));
  return {"gauge", gauge, rows};
}

}  // namespace selfcal::recovery
