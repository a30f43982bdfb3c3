// The file of a Gough-Stewart platform, read and written (app/selfcal-data.5: legs, home).
#include "kinematics/robots/gough_stewart.h"

namespace selfcal::gough_stewart {
namespace {

const std::vector<MassKey>& leg_masses() {
  static const std::vector<MassKey> keys = {{"platform", &LoopMasses::platform},
                                            {"cylinders", &LoopMasses::cylinder},
                                            {"cylinder_com", &LoopMasses::cylinder_com, true},
                                            {"pistons", &LoopMasses::piston},
                                            {"piston_com", &LoopMasses::piston_com, true}};
  return keys;
}

std::vector<Named> leg_figures(int leg) {
  static constexpr const char* kNames[kFields] = {"bx", "by", "bz", "px", "py", "pz", "offset"};
  std::vector<Named> list;
  for (int field = 0; field < kFields; ++field) list.push_back({kNames[field], index(leg, field)});
  return list;
}

void read_leg(const Node& node, int leg, Problems& problems, GoughStewart& model) {
  Fields fields(node, leg_name(leg), problems);
  model.value.segment<3>(index(leg, kBase)) = platform::read_centre(fields, "base");
  model.value.segment<3>(index(leg, kPlatform)) = platform::read_centre(fields, "platform");
  model.value[index(leg, kOffset)] = fields.length("offset", 0);
  const Eigen::Vector2d limits = read_travel(fields).value_or(Eigen::Vector2d::Zero());
  const auto i = static_cast<size_t>(leg);
  if (!fields.has("limits")) fields.fail("limits", "the lowest and the highest reading in metres");
  if (fields.has("limits") && !(limits[0] + model.value[index(leg, kOffset)] > 0))
    fields.fail("limits", "readings at which the leg is longer than nothing");
  model.lower[i] = limits[0];
  model.upper[i] = limits[1];
  model.swing[i] = platform::read_swing(fields);
  read_beside(fields, leg_figures(leg), problems, model);
  fields.refuse_unknown();
}

Node write_leg(const GoughStewart& model, int leg) {
  Node node = Node::map();
  const auto i = static_cast<size_t>(leg);
  node.set("base", Node::of(Eigen::VectorXd(model.value.segment<3>(index(leg, kBase)))));
  node.set("platform", Node::of(Eigen::VectorXd(model.value.segment<3>(index(leg, kPlatform)))));
  node.set("offset", Node::of(model.value[index(leg, kOffset)]));
  node.set("limits", Node::of(std::vector<double>{model.lower[i], model.upper[i]}));
  if (const platform::Swing& swing = model.swing[i]; swing.universal > 0)
    node.set("swing", Node::of(std::vector<double>{swing.universal, swing.spherical}));
  write_beside(model, leg_figures(leg), node);
  return node;
}

}  // namespace

std::string leg_name(int leg) { return "leg" + std::to_string(leg + 1); }

GoughStewart read(const Node& node, Problems& problems) {
  Fields fields(node, "robot", problems);
  GoughStewart model;
  model.name = fields.text("robot");
  fields.text("kind");
  const Node* legs = fields.node("legs");
  if (!legs || legs->kind != Node::Kind::list || legs->items.size() != kLegs) {
    fields.fail("legs", "a list of six legs");
    return model;
  }
  for (int leg = 0; leg < kLegs; ++leg)
    read_leg(legs->items[static_cast<size_t>(leg)], leg, problems, model);
  model.home = platform::read_home(fields, problems);
  model.masses = read_masses(fields, leg_masses(), problems);
  fields.refuse_unknown();
  return model;
}

Node write(const GoughStewart& model) {
  Node node = Node::map();
  node.set("robot", Node::of(model.name));
  node.set("kind", Node::of(std::string("gough-stewart")));
  Node legs = Node::list();
  for (int leg = 0; leg < kLegs; ++leg) legs.items.push_back(write_leg(model, leg));
  node.set("legs", std::move(legs));
  if (model.home) node.set("home", platform::write_home(*model.home));
  write_masses(model.masses, leg_masses(), node);
  return node;
}

}  // namespace selfcal::gough_stewart
