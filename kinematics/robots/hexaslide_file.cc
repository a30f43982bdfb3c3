// The file of a Hexa Slide, read and written (app/selfcal-data.5: chains, home), and the names,
// priors and order of preference of its parameters: lengths and joints first, then the rails, last
// the coordinates that hold the frame of the platform and that of the base.
#include <algorithm>

#include "kinematics/robots/hexaslide.h"

namespace selfcal::hexaslide {
namespace {

constexpr const char* kChainNames[kFields] = {"sx", "sy", "sz", "ax",    "ay",
                                              "px", "py", "pz", "length"};

const std::vector<MassKey>& chain_masses() {
  static const std::vector<MassKey> keys = {{"platform", &LoopMasses::platform},
                                            {"carriages", &LoopMasses::carriage},
                                            {"links", &LoopMasses::rod}};
  return keys;
}

std::vector<Named> chain_figures(int chain) {
  std::vector<Named> list;
  for (int field = 0; field < kFields; ++field)
    list.push_back({kChainNames[field], index(chain, field)});
  return list;
}

void read_chain(const Node& node, int chain, Problems& problems, Hexaslide& model) {
  Fields fields(node, chain_name(chain), problems);
  model.value.segment<3>(index(chain, kStart)) = platform::read_centre(fields, "rail_start");
  model.value.segment<3>(index(chain, kJoint)) = platform::read_centre(fields, "platform");
  if (const auto direction = fields.numbers("rail_direction", 2)) {
    model.value.segment<2>(index(chain, kDirection)) = *direction;
    if (!(direction->norm() < 1))
      fields.fail("rail_direction", "two components of a unit vector, the third below 0");
  } else if (!fields.has("rail_direction")) {
    fields.fail("rail_direction", "[ax, ay]");
  }
  model.value[index(chain, kLink)] = fields.length("length", 0);
  if (!(model.value[index(chain, kLink)] > 0)) fields.fail("length", "a positive number of metres");
  const Eigen::Vector2d limits = read_travel(fields).value_or(Eigen::Vector2d::Zero());
  const auto i = static_cast<size_t>(chain);
  model.lower[i] = limits[0];
  model.upper[i] = limits[1];
  model.swing[i] = platform::read_swing(fields);
  read_beside(fields, chain_figures(chain), problems, model);
  fields.refuse_unknown();
}

Node write_chain(const Hexaslide& model, int chain) {
  Node node = Node::map();
  const auto i = static_cast<size_t>(chain);
  const auto part = [&](int field, int count) {
    return Node::of(Eigen::VectorXd(model.value.segment(index(chain, field), count)));
  };
  node.set("rail_start", part(kStart, 3)).set("rail_direction", part(kDirection, 2));
  node.set("platform", part(kJoint, 3));
  node.set("length", Node::of(model.value[index(chain, kLink)]));
  if (model.lower[i] < model.upper[i])
    node.set("limits", Node::of(std::vector<double>{model.lower[i], model.upper[i]}));
  if (const platform::Swing& swing = model.swing[i]; swing.universal > 0)
    node.set("swing", Node::of(std::vector<double>{swing.universal, swing.spherical}));
  write_beside(model, chain_figures(chain), node);
  return node;
}

Parameter chain_parameter(const Hexaslide& model, int chain, int field) {
  Parameter p;
  p.name = kChainNames[field] + std::to_string(chain + 1);
  p.frame = chain_name(chain);
  p.field = kChainNames[field];
  if (field >= kDirection && field < kJoint) p.quantity = Quantity::angle;
  take_figures(model, index(chain, field), kOwnTolerance, p);
  return p;
}

/// Indices of the coordinates that hold the frame of the points at `field`.
std::vector<int> holding_points(const Hexaslide& model, int field) {
  platform::Centres centres;
  for (int i = 0; i < kChains; ++i) centres.col(i) = model.nominal.segment<3>(index(i, field));
  std::vector<int> list;
  for (const int at : platform::frame_coordinates(centres))
    list.push_back(index(at / 3, field + at % 3));
  return list;
}

}  // namespace

std::string chain_name(int chain) { return "chain" + std::to_string(chain + 1); }

Hexaslide read(const Node& node, Problems& problems) {
  Fields fields(node, "robot", problems);
  Hexaslide model;
  model.name = fields.text("robot");
  fields.text("kind");
  const Node* chains = fields.node("chains");
  if (!chains || chains->kind != Node::Kind::list || chains->items.size() != kChains) {
    fields.fail("chains", "a list of six chains");
    return model;
  }
  for (int chain = 0; chain < kChains; ++chain)
    read_chain(chains->items[static_cast<size_t>(chain)], chain, problems, model);
  model.home = platform::read_home(fields, problems);
  model.masses = read_masses(fields, chain_masses(), problems);
  fields.refuse_unknown();
  return model;
}

Node write(const Hexaslide& model) {
  Node node = Node::map();
  node.set("robot", Node::of(model.name));
  node.set("kind", Node::of(std::string("hexaslide")));
  Node chains = Node::list();
  for (int chain = 0; chain < kChains; ++chain) chains.items.push_back(write_chain(model, chain));
  node.set("chains", std::move(chains));
  if (model.home) node.set("home", platform::write_home(*model.home));
  write_masses(model.masses, chain_masses(), node);
  return node;
}

std::vector<Parameter> parameters(const Hexaslide& model) {
  std::vector<Parameter> list;
  for (int chain = 0; chain < kChains; ++chain)
    for (int field = 0; field < kFields; ++field)
      list.push_back(chain_parameter(model, chain, field));
  return list;
}

std::vector<int> preference(const Hexaslide& model) {
  std::vector<int> last = holding_points(model, kJoint);
  for (const int each : holding_points(model, kStart)) last.push_back(each);
  std::vector<int> order;
  for (const int field : {int{kLink}, int{kJoint}, kJoint + 1, kJoint + 2, int{kDirection},
                          kDirection + 1, int{kStart}, kStart + 1, kStart + 2})
    for (int i = 0; i < kChains; ++i)
      if (const int at = index(i, field); std::find(last.begin(), last.end(), at) == last.end())
        order.push_back(at);
  order.insert(order.end(), last.begin(), last.end());
  return order;
}

}  // namespace selfcal::hexaslide
