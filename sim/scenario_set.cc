// One entry of a scenario's sets: the scenario's own keys are read and taken out, what is left is
// an entry of dataset.yaml.
#include <string_view>
#include <vector>

#include "constraints/sampling/cell_geometry.h"
#include "sim/scenario.h"

namespace selfcal {
namespace {

const std::vector<std::string_view> kOwnKeys = {
    "rows",    "rows_per_group", "noise_true", "noise_angle_true", "surface",
    "outward", "truth",          "within",     "places",           "locked"};
constexpr double kMostNoise = 0.1;  // m or rad

}  // namespace

SetScenario read_set_scenario(const std::string& name, const Node& node, Problems& problems) {
  Fields fields(node, "set " + name, problems);
  SetScenario set;
  set.name = name;
  set.entry = node.without(kOwnKeys);
  set.rows = fields.integer("rows", set.rows, 1, 1000000);
  set.rows_per_group = fields.integer("rows_per_group", set.rows_per_group, 2, 10000);
  // make_set judges `noise` itself.
  const double noise = fields.number("noise", 0), noise_angle = fields.number("noise_angle", 0);
  set.noise = fields.number("noise_true", noise, 0, kMostNoise);
  set.noise_angle = fields.number("noise_angle_true", noise_angle, 0, kMostNoise);
  if (const Node* given = fields.node("noise_angle_true")) set.noise_angle_true = given->place;
  if (const Node* surface = fields.node("surface"))
    set.surface = read_surface(*surface, "set " + name + " surface", problems);
  if (fields.has("outward")) set.outward = read_unit(fields, "outward");
  if (set.surface && set.outward) fields.fail("outward", "either `surface` or `outward`");
  set.truth = named_numbers(fields, "truth", problems);
  if (set.surface && !set.truth.empty()) fields.fail("truth", "either `surface` or `truth`");
  if (const Node* within = fields.node("within"))
    set.within = read_patch(*within, "set " + name + " within", problems);
  if (const Node* places = fields.node("places"))
    set.places = read_places(*places, "set " + name + " places", problems);
  set.locked = fields.texts("locked");
  if (const Node* locked = fields.node("locked")) set.locked_place = locked->place;
  return set;
}

}  // namespace selfcal
