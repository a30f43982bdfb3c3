// The file of a linear delta, read and written (app/selfcal-data.5: towers, effector, tool).
#include <cmath>
#include <numbers>

#include "kinematics/robots/linear_delta.h"

namespace selfcal::linear_delta {
namespace {

constexpr double kWidestSwing = std::numbers::pi / 2;  // rad

const std::vector<MassKey>& tower_masses() {
  static const std::vector<MassKey> keys = {{"effector", &LoopMasses::platform},
                                            {"carriages", &LoopMasses::carriage},
                                            {"rods", &LoopMasses::rod}};
  return keys;
}

std::vector<Named> tower_names(int t) {
  return {{"radius", index(t, kRadius)}, {"angle", index(t, kAngle)},
          {"rod", index(t, kRod)},       {"endstop", index(t, kEndstop)},
          {"tilt_x", index(t, kTiltX)},  {"tilt_y", index(t, kTiltY)},
          {"scale", index(t, kScale)}};
}
const std::vector<Named>& effector_names() {
  static const std::vector<Named> names = {{"rx", kEffector}, {"ry", kEffector + 1}};
  return names;
}
const std::vector<Named>& tool_names() {
  static const std::vector<Named> names = {{"x", kTool}, {"y", kTool + 1}, {"z", kTool + 2}};
  return names;
}

void read_tower(const Node& node, int t, Problems& problems, Delta& model) {
  Fields fields(node, tower_name(t), problems);
  const auto at = [&](int field) -> double& { return model.value[index(t, field)]; };
  const auto length = [&](const char* key, int field) {
    if (!fields.has(key)) fields.fail(key, "metres");
    at(field) = fields.length(key, 1);
    if (at(field) <= 0) fields.fail(key, "a positive number of metres");
  };
  length("radius", kRadius);
  length("rod", kRod);
  if (!fields.has("angle")) fields.fail("angle", "radians");
  at(kAngle) = fields.angle("angle", 0);
  if (!fields.has("endstop")) fields.fail("endstop", "metres");
  at(kEndstop) = fields.length("endstop", 0);
  if (const auto tilt = fields.numbers("tilt", 2)) {
    at(kTiltX) = (*tilt)[0];
    at(kTiltY) = (*tilt)[1];
    if (!(tilt->norm() < 1)) fields.fail("tilt", "two small angles in radians (degrees?)");
  }
  at(kScale) = fields.number("scale", 1.0);
  if (at(kScale) == 0) fields.fail("scale", "a ratio other than 0");
  if (const auto limits = read_travel(fields)) {
    model.lower[static_cast<size_t>(t)] = (*limits)[0];
    model.upper[static_cast<size_t>(t)] = (*limits)[1];
  }
  if (fields.has("swing")) {
    double& swing = model.swing[static_cast<size_t>(t)] = fields.angle("swing", 0);
    if (!(swing > 0 && swing < kWidestSwing))
      fields.fail("swing", "an angle in radians, above 0 and below a right one");
  }
  read_beside(fields, tower_names(t), problems, model);
  fields.refuse_unknown();
}

void read_effector(const Node& node, Problems& problems, Delta& model) {
  Fields fields(node, "effector", problems);
  for (const Named& each : effector_names()) model.value[each.at] = fields.angle(each.name, 0);
  read_beside(fields, effector_names(), problems, model);
  fields.refuse_unknown();
}

/// [x, y, z], or with what stands beside them {x, y, z, tolerance, nominal}.
void read_tool(Fields& robot, const Node& node, Problems& problems, Delta& model) {
  if (node.kind != Node::Kind::map) {
    if (const auto tool = robot.numbers("tool", 3)) {
      model.value.segment<3>(kTool) = *tool;
      if (!(tool->cwiseAbs().maxCoeff() <= kLongestPart))
        robot.fail("tool", "metres (millimetres?)");
    }
    model.nominal.segment<3>(kTool) = model.value.segment<3>(kTool);
    return;
  }
  Fields fields(node, "tool", problems);
  for (const Named& each : tool_names()) model.value[each.at] = fields.length(each.name, 0);
  read_beside(fields, tool_names(), problems, model);
  fields.refuse_unknown();
}

Node write_tower(const Delta& model, int t) {
  Node node = Node::map();
  for (const Named& each : tower_names(t))
    if (each.at < index(t, kTiltX)) node.set(each.name, Node::of(model.value[each.at]));
  const Eigen::VectorXd tilt = model.value.segment<2>(index(t, kTiltX));
  if (!tilt.isZero(0)) node.set("tilt", Node::of(tilt));
  const double scale = model.value[index(t, kScale)];
  if (scale != 1) node.set("scale", Node::of(scale));
  const auto i = static_cast<size_t>(t);
  if (model.lower[i] < model.upper[i])
    node.set("limits", Node::of(std::vector<double>{model.lower[i], model.upper[i]}));
  if (model.swing[i] > 0) node.set("swing", Node::of(model.swing[i]));
  write_beside(model, tower_names(t), node);
  return node;
}

Node write_named(const Delta& model, const std::vector<Named>& names) {
  Node node = Node::map();
  for (const Named& each : names)
    if (model.value[each.at] != 0) node.set(each.name, Node::of(model.value[each.at]));
  write_beside(model, names, node);
  return node;
}

}  // namespace

std::string tower_name(int tower) { return "tower" + std::to_string(tower + 1); }

Delta read(const Node& node, Problems& problems) {
  Fields fields(node, "robot", problems);
  Delta model;
  model.name = fields.text("robot");
  fields.text("kind");
  const Node* towers = fields.node("towers");
  if (!towers || towers->kind != Node::Kind::list || towers->items.size() != kTowers) {
    fields.fail("towers", "a list of three towers");
    return model;
  }
  for (int t = 0; t < kTowers; ++t)
    read_tower(towers->items[static_cast<size_t>(t)], t, problems, model);
  if (const Node* effector = fields.node("effector")) read_effector(*effector, problems, model);
  if (const Node* tool = fields.node("tool")) read_tool(fields, *tool, problems, model);
  model.masses = read_masses(fields, tower_masses(), problems);
  fields.refuse_unknown();
  return model;
}

Node write(const Delta& model) {
  Node node = Node::map();
  node.set("robot", Node::of(model.name));
  node.set("kind", Node::of(std::string("linear-delta")));
  Node towers = Node::list();
  for (int t = 0; t < kTowers; ++t) towers.items.push_back(write_tower(model, t));
  node.set("towers", std::move(towers));
  Node effector = write_named(model, effector_names());
  if (!effector.items.empty()) node.set("effector", std::move(effector));
  Node beside = Node::map();
  if (write_beside(model, tool_names(), beside))
    node.set("tool", write_named(model, tool_names()));
  else if (const Eigen::VectorXd tool = model.value.segment<3>(kTool); !tool.isZero(0))
    node.set("tool", Node::of(tool));
  write_masses(model.masses, tower_masses(), node);
  return node;
}

}  // namespace selfcal::linear_delta
