// A UR10's figures, each drawn anew within a fifth or so; what legs carry by their length.
#include "sim/trials/trial_robot.h"

#include <array>
#include <cmath>
#include <numbers>

#include "kinematics/expects.h"
#include "kinematics/make_robot.h"
#include "sim/trials/trial_world.h"

namespace selfcal {
namespace {

constexpr double kRight = std::numbers::pi / 2;

struct ArmFrame {
  const char* name;
  double alpha, d, r, lower, upper, mass;
  std::array<double, 3> com;
};

constexpr ArmFrame kArm[] = {
    {"j1", 0, 0, 0.1273, -3.1, 3.1, 7.8, {0, 0.02, 0}},
    {"j2", kRight, 0, 0, -2.6, -0.28, 12.9, {-0.24, 0, 0.16}},
    {"j3", 0, -0.612, 0, -2.4, 2.4, 3.9, {-0.29, 0, 0.07}},
    {"j4", 0, -0.5723, 0.1639, -3.1, 3.1, 2, {0, -0.01, 0.02}},
    {"j5", kRight, 0, 0.1157, -2.6, 2.6, 2, {0, 0.01, 0.02}},
    {"j6", -kRight, 0, 0.0922, -3.1, 3.1, 0.4, {0, 0, -0.02}},
};

Node joint_node(const ArmFrame& frame, Random& random) {
  Node node = Node::map();
  node.set("name", Node::of(std::string(frame.name)));
  node.set("joint", Node::of(std::string("revolute")));
  if (frame.alpha != 0) node.set("alpha", Node::of(frame.alpha));
  if (frame.d != 0) node.set("d", Node::of(frame.d * uniform(random, 0.85, 1.2)));
  if (frame.r != 0) node.set("r", Node::of(frame.r * uniform(random, 0.85, 1.2)));
  node.set("limits", Node::of(Eigen::VectorXd(Eigen::Vector2d(frame.lower, frame.upper))));
  node.set("mass", Node::of(frame.mass * uniform(random, 0.8, 1.4)));
  node.set("com", Node::of(Eigen::VectorXd(Eigen::Map<const Eigen::Vector3d>(frame.com.data()))));
  return node;
}

Node tool_node(Random& random) {
  Node node = Node::map();
  node.set("name", Node::of(std::string("tool")));
  node.set("joint", Node::of(std::string("fixed")));
  node.set("alpha", Node::of(uniform(random, 0, 1.3)));
  node.set("d", Node::of(uniform(random, 0.02, 0.2)));
  node.set("theta", Node::of(uniform(random, 0, 1.5)));
  node.set("r", Node::of(uniform(random, 0.1, 0.22)));
  node.set("mass", Node::of(uniform(random, 1, 5)));
  node.set("com", Node::of(Eigen::VectorXd(Eigen::Vector3d(0, 0, -0.05))));
  return node;
}

/// Mean of the legs in the middle of the readings (m): everything that they carry goes by it.
double leg_length(const Robot& robot) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = robot.joints()[static_cast<size_t>(j)];
    q[j] = (joint.lower + joint.upper) / 2;
  }
  return robot.leg_lengths(values(robot), q).mean();
}

}  // namespace

std::unique_ptr<Robot> draw_arm(Random& random) {
  Node base = Node::map();
  base.set("name", Node::of(std::string("base")));
  base.set("joint", Node::of(std::string("fixed")));
  base.set("r", Node::of(uniform(random, 0, 0.5)));
  Node frames = Node::list();
  frames.items.push_back(base);
  for (const ArmFrame& frame : kArm) frames.items.push_back(joint_node(frame, random));
  frames.items.push_back(tool_node(random));
  Node robot = Node::map();
  robot.set("robot", Node::of(std::string("arm")));
  robot.set("kind", Node::of(std::string("serial")));
  robot.set("frames", frames);
  Problems problems;
  auto arm = make_robot(robot, problems);
  expects(arm != nullptr && !problems.any(), "a trial's arm is well formed");
  return arm;
}

Eigen::VectorXd draw_geometry(const Robot& robot, Random& random) {
  const double length = uniform(random, 3e-4, 1e-3), angle = uniform(random, 3e-4, 1e-3);
  const double gear = uniform(random, 5e-5, 1e-4), placed = uniform(random, 2e-3, 5e-3);
  Eigen::VectorXd xi = values(robot);
  for (Eigen::Index i = 0; i < xi.size(); ++i) {
    const Parameter& p = robot.parameters()[static_cast<size_t>(i)];
    const double drawn = normal(random);
    if (p.part == Part::link) xi[i] += drawn * (p.quantity == Quantity::length ? length : angle);
    if (p.part == Part::gear) xi[i] += drawn * gear;
    if (p.part == Part::base || p.part == Part::tool) xi[i] += drawn * placed;
  }
  return xi;
}

Weights draw_weights(const Robot& robot, Random& random) {
  Weights weights;
  if (runs_on_legs(robot)) {
    const double length = leg_length(robot);
    weights.mass.push_back(uniform(random, 30, 60) * std::pow(length, 3));
    weights.com.push_back(0.05 * length *
                          Eigen::Vector3d(normal(random), normal(random), normal(random)));
    return weights;
  }
  for (const Link& link : robot.statics()->mechanics().links) {
    const double off = uniform(random, 0.1, 0.2) * (chance(random, 0.5) ? 1 : -1);
    weights.mass.push_back(link.mass.value_or(0) * (1 + off));
    weights.com.push_back(link.com +
                          0.01 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
  }
  return weights;
}

double most_load(const Robot& robot) {
  return runs_on_legs(robot) ? 400 * std::pow(leg_length(robot), 3) : 40;
}

}  // namespace selfcal
