#include "kinematics/robots/loop_masses.h"

namespace selfcal {
namespace {

constexpr double kMostOnEarth = 20;  // m/s^2

}  // namespace

LoopMasses read_masses(Fields& robot, const std::vector<MassKey>& keys, Problems& problems) {
  LoopMasses masses;
  if (const auto gravity = robot.numbers("gravity", 3)) {
    masses.gravity = *gravity;
    if (gravity->norm() > kMostOnEarth) robot.fail("gravity", "m/s^2, 9.81 on earth");
  }
  const Node* node = robot.node("masses");
  if (!node) return masses;
  masses.known = true;
  Fields fields(*node, "masses", problems);
  for (const MassKey& key : keys) {
    double& figure = masses.*key.figure;
    figure = key.length ? fields.length(key.name, 0) : fields.number(key.name, 0.0);
    if (figure < 0) fields.fail(key.name, key.length ? "metres" : "at least 0 kg");
  }
  if (const auto com = fields.numbers("com", 3)) {
    masses.com = *com;
    if (!(com->cwiseAbs().maxCoeff() <= kLongestPart)) fields.fail("com", "metres (millimetres?)");
  }
  fields.refuse_unknown();
  return masses;
}

void write_masses(const LoopMasses& masses, const std::vector<MassKey>& keys, Node& robot) {
  if (masses.gravity) robot.set("gravity", Node::of(Eigen::VectorXd(*masses.gravity)));
  if (!masses.known) return;
  Node node = Node::map();
  for (const MassKey& key : keys)
    if (masses.*key.figure != 0) node.set(std::string(key.name), Node::of(masses.*key.figure));
  if (!masses.com.isZero(0)) node.set("com", Node::of(Eigen::VectorXd(masses.com)));
  robot.set("masses", std::move(node));
}

std::optional<PointMasses> point_masses(const LoopMasses& masses) {
  if (!masses.known && !masses.gravity) return std::nullopt;
  PointMasses all;
  if (masses.gravity) all.gravity = *masses.gravity;
  if (masses.platform > 0)
    all.points.push_back({"platform", Body::last_link, masses.com, masses.platform});
  return all;
}

}  // namespace selfcal
