// One entry of a scenario's sets: the scenario's own keys are read and taken out, what is left is
// an entry of dataset.yaml.
#include <algorithm>
#include <array>

#include "sim/scenario_fields.h"

namespace selfcal {
namespace {

constexpr std::array<std::string_view, 8> kOwnKeys = {
    "rows",    "rows_per_group", "noise_true", "noise_angle_true",
    "surface", "outward",        "truth",      "within"};
constexpr double kMostNoise = 0.1;  // m or rad

Node without_own_keys(const Node& node) {
  Node rest = Node::map();
  rest.place = node.place;
  for (std::size_t i = 0; i < node.keys.size(); ++i)
    if (std::ranges::find(kOwnKeys, node.keys[i]) == kOwnKeys.end())
      rest.set(node.keys[i], node.items[i]);
  return rest;
}

Eigen::Vector3d read_point(Fields& fields, std::string_view key) {
  const auto point = fields.numbers(key, 3);
  if (!fields.has(key)) fields.fail(key, "[x, y, z] (m)");
  return point ? Eigen::Vector3d(*point) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d read_unit(Fields& fields, std::string_view key) {
  const Eigen::Vector3d direction = read_point(fields, key);
  if (fields.has(key) && direction.norm() < 1e-9) fields.fail(key, "a direction that is not zero");
  return direction.normalized();
}

void read_surface(Fields& fields, Surface& surface) {
  surface.point = read_point(fields, "point");
  surface.normal = read_unit(fields, "normal");
}

void read_patch(Fields& fields, Patch& patch) {
  patch.centre = read_point(fields, "center");
  patch.radius = fields.number("radius");
  if (fields.has("radius") && !(patch.radius > 0)) fields.fail("radius", "a positive radius (m)");
}

}  // namespace

SetScenario read_set_scenario(const std::string& name, const Node& node, Problems& problems) {
  Fields fields(node, "set " + name, problems);
  SetScenario set;
  set.name = name;
  set.entry = without_own_keys(node);
  set.rows = fields.integer("rows", set.rows, 1, 1000000);
  set.rows_per_group = fields.integer("rows_per_group", set.rows_per_group, 2, 10000);
  // make_set judges `noise` itself.
  const double noise = fields.number("noise", 0), noise_angle = fields.number("noise_angle", 0);
  set.noise = number_within(fields, "noise_true", noise, 0, kMostNoise);
  set.noise_angle = number_within(fields, "noise_angle_true", noise_angle, 0, kMostNoise);
  if (const Node* given = fields.node("noise_angle_true")) set.noise_angle_true = given->place;
  if (const Node* surface = fields.node("surface"))
    set.surface = read_whole<Surface>(*surface, "set " + name + " surface", problems, read_surface);
  if (fields.has("outward")) set.outward = read_unit(fields, "outward");
  if (set.surface && set.outward) fields.fail("outward", "either `surface` or `outward`");
  set.truth = named_numbers(fields, "truth", problems);
  if (set.surface && !set.truth.empty()) fields.fail("truth", "either `surface` or `truth`");
  if (const Node* within = fields.node("within"))
    set.within = read_whole<Patch>(*within, "set " + name + " within", problems, read_patch);
  return set;
}

}  // namespace selfcal
