#include "kinematics/make_robot.h"

#include <string>

#include "kinematics/corrected_robot.h"

namespace selfcal {

#define X(identifier, text) \
  std::unique_ptr<Robot> make_##identifier(const Node& node, Problems& problems);
#include "kinematics/robots.def"
#undef X

namespace {

struct Kind {
  std::string_view name;
  std::unique_ptr<Robot> (*make)(const Node&, Problems&);
};

constexpr Kind kKinds[] = {
#define X(identifier, text) {text, make_##identifier},
#include "kinematics/robots.def"
#undef X
};

/// The robot of a kind, and around it the effects that the file says it has.
std::unique_ptr<Robot> with_effects_of(const Node& node, const Kind& kind, Problems& problems) {
  const Node* effects = node.find("effects");
  if (!effects) return kind.make(node, problems);
  std::shared_ptr<const Robot> robot = kind.make(node.without({"effects"}), problems);
  if (!robot) return nullptr;
  if (effects->kind != Node::Kind::list) {
    problems.add(effects->place, "effects: expected a list of effects");
    return nullptr;
  }
  auto corrected = correct(std::move(robot), effects->items, {}, problems);
  // A text has those that differ in their values alone as one.
  if (corrected && effect_entries(*corrected).size() < effects->items.size())
    problems.add(effects->place, "effects: one is there twice, at one place and of one kind");
  return problems.any() ? nullptr : std::move(corrected);
}

}  // namespace

std::unique_ptr<Robot> make_robot(const Node& node, Problems& problems) {
  const Node* kind = node.find("kind");
  if (!kind) {
    problems.add(node.place, "robot: key 'kind' is missing");
    return nullptr;
  }
  std::string known;
  for (const Kind& each : kKinds) {
    if (each.name == kind->text) return with_effects_of(node, each, problems);
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  problems.add(kind->place, "robot: kind '" + kind->text + "' is unknown; known: " + known);
  return nullptr;
}

std::vector<std::string_view> robot_kinds() {
  std::vector<std::string_view> names;
  for (const Kind& each : kKinds) names.push_back(each.name);
  return names;
}

}  // namespace selfcal
