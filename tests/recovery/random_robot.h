// Random serial robots whose makers' tolerances are told, and truths drawn from them.
#pragma once

#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "kinematics/make_robot.h"
#include "kinematics/robot.h"

namespace selfcal::recovery {

inline constexpr double kLength = 1.0e-3, kAngle = 1.0e-3;              // 1 sigma of links
inline constexpr double kPlacedLength = 5.0e-3, kPlacedAngle = 5.0e-3;  // of base and tool

inline Node tolerance(double length, double angle) {
  Node node = Node::map();
  for (const char* name : {"alpha", "theta", "beta"}) node.set(name, Node::of(angle));
  for (const char* name : {"d", "r"}) node.set(name, Node::of(length));
  return node;
}

inline Node frame(const std::string& name, const std::string& joint, double alpha, double d,
                  double theta, double r, bool placed) {
  Node node = Node::map();
  node.set("name", Node::of(name)).set("joint", Node::of(joint));
  node.set("alpha", Node::of(alpha)).set("d", Node::of(d));
  node.set("theta", Node::of(theta)).set("r", Node::of(r));
  node.set("tolerance",
           placed ? tolerance(kPlacedLength, kPlacedAngle) : tolerance(kLength, kAngle));
  return node;
}

/// A base or tool frame as a whole pose.
inline Node whole_frame(const std::string& name, const Eigen::Vector3d& xyz,
                        const Eigen::Vector3d& rpy) {
  Node tolerance = Node::map();
  for (const char* field : {"x", "y", "z"}) tolerance.set(field, Node::of(kPlacedLength));
  for (const char* field : {"rx", "ry", "rz"}) tolerance.set(field, Node::of(kPlacedAngle));
  Node node = Node::map();
  node.set("name", Node::of(name)).set("joint", Node::of(std::string("fixed")));
  node.set("xyz", Node::of(Eigen::VectorXd(xyz))).set("rpy", Node::of(Eigen::VectorXd(rpy)));
  node.set("tolerance", std::move(tolerance));
  return node;
}

/// Six joints (now and then five or seven, now and then one prismatic) with links of 0.1 to 0.6 m;
/// of every second robot the base and the tool are whole poses.
inline std::unique_ptr<Robot> random_robot(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const double quarter = std::numbers::pi / 2;
  const int joints = 5 + static_cast<int>(uniform(0, 3));
  const int prismatic = uniform(0, 1) < 0.2 ? 2 : -1;
  const bool whole = uniform(0, 1) < 0.5;
  Node frames = Node::list();
  frames.items.push_back(
      whole ? whole_frame("base", {uniform(-1, 1), uniform(-1, 1), uniform(0, 0.5)},
                          {uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-3, 3)})
            : frame("base", "fixed", 0, 0, uniform(-3, 3), uniform(0, 0.5), true));
  for (int j = 0; j < joints; ++j) {
    const bool turns = uniform(0, 1) < 0.7;
    const double alpha = j == 0 ? 0.1 : turns ? (uniform(0, 1) < 0.5 ? quarter : -quarter) : 0;
    const bool slides = j == prismatic;
    Node node = frame("j" + std::to_string(j + 1), slides ? "prismatic" : "revolute", alpha,
                      j > 0 && uniform(0, 1) < 0.6 ? uniform(0.1, 0.6) : 0, 0,
                      !slides && j > 0 && uniform(0, 1) < 0.5 ? uniform(0.1, 0.5) : 0, false);
    const double reach = slides ? 0.3 : 2.6;
    node.set("limits", Node::of(Eigen::VectorXd(Eigen::Vector2d(slides ? 0.1 : -reach, reach))));
    frames.items.push_back(std::move(node));
  }
  frames.items.push_back(
      whole ? whole_frame("tool", {uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(0.05, 0.2)},
                          {uniform(-3, 3), uniform(-1, 1), uniform(-3, 3)})
            : frame("tool", "fixed", uniform(0.3, 1.3), uniform(0.05, 0.2), uniform(-2, 2), 0.1,
                    true));
  Node robot = Node::map();
  robot.set("robot", Node::of(std::string("random"))).set("kind", Node::of(std::string("serial")));
  robot.set("frames", std::move(frames));
  Problems problems;
  return make_robot(robot, problems);
}

/// Parameters of a machine that its maker built within the tolerances; gear ratios are exact.
inline Eigen::VectorXd draw_truth(const Robot& robot, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = nominal_values(robot);
  for (size_t i = 0; i < robot.parameters().size(); ++i)
    if (robot.parameters()[i].part != Part::gear)
      xi[static_cast<Eigen::Index>(i)] += robot.parameters()[i].tolerance * normal(random);
  return xi;
}

}  // namespace selfcal::recovery
