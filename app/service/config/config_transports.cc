#include "app/service/config/config_transports.h"

#include <algorithm>
#include <numeric>

namespace selfcal {
namespace {

void refuse_unknown_kind(Fields& fields, const std::string& kind,
                         const std::vector<std::string_view>& known) {
  if (std::ranges::find(known, kind) != known.end()) return;
  std::string names;
  for (const std::string_view name : known)
    names += (names.empty() ? "" : ", ") + std::string(name);
  fields.fail("kind", "one of " + names);
}

/// The same with the keys of every mapping in order: to write them in another one says nothing new.
Node sorted(const Node& node) {
  if (node.items.empty()) return node;
  Node out = node.kind == Node::Kind::map ? Node::map() : Node::list();
  std::vector<std::size_t> order(node.items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (node.kind == Node::Kind::map)
    std::ranges::sort(order, {}, [&](std::size_t i) { return node.keys[i]; });
  for (const std::size_t i : order)
    if (node.kind == Node::Kind::map)
      out.set(node.keys[i], sorted(node.items[i]));
    else
      out.items.push_back(sorted(node.items[i]));
  return out;
}

void read_encoders(const Node& node, const std::filesystem::path& folder, Config& config,
                   Problems& problems) {
  Fields f(node, "encoders", problems);
  // Where the kind wants to know more of each joint it is a mapping, and the kind's own key.
  const Node* joints = f.node("joints");
  const bool mapped = joints && joints->kind == Node::Kind::map;
  if (!mapped) config.joint_names = f.texts("joints");
  const std::vector<Joint>& of_robot = config.robot->joints();
  if (config.joint_names.empty())
    for (const Joint& joint : of_robot) config.joint_names.push_back(joint.name);
  if (config.joint_names.size() != of_robot.size())
    f.fail("joints", std::to_string(of_robot.size()) + " names");
  config.silence = f.number("silence", config.silence, 0.01, 60);
  const Node nuisance = node.without({"kind", mapped ? "kind" : "joints", "silence"});
  const std::string kind = f.text("kind", "dds");
  config.encoders = make_encoders(kind, {nuisance, config.joint_names, of_robot, folder, problems});
  refuse_unknown_kind(f, kind, encoder_kinds());
}

void read_trigger(const Node& node, Config& config, Problems& problems) {
  Fields f(node, "trigger", problems);
  config.touch.debounce = f.number("debounce", config.touch.debounce, 0, 0.1);
  config.touch.delay = f.number("delay", config.touch.delay, 0, 0.1);
  const Node nuisance = node.without({"kind", "debounce", "delay"});
  const std::string kind = f.text("kind", "dds");
  config.trigger = make_trigger(kind, {nuisance, config.id, problems});
  refuse_unknown_kind(f, kind, trigger_kinds());
}

}  // namespace

void read_transports(Fields& fields, const std::filesystem::path& folder, Config& config,
                     Problems& problems) {
  const Node &encoders = entry_of(fields, "encoders"), &trigger = entry_of(fields, "trigger");
  read_encoders(encoders, folder, config, problems);
  read_trigger(trigger, config, problems);
  config.transports = Node::map();
  config.transports.set("encoders", sorted(encoders.without({"silence"})));
  config.transports.set("trigger", sorted(trigger.without({"debounce"})));
  if (problems.any() || config.encoders->stamped_by() == config.trigger->stamped_by()) return;
  // A message carries its sender's stamps, a frame and an edge get those of our kernel; between
  // the two lies the time that the message was under way, and a touch would be off by it.
  fields.fail("trigger",
              "a kind that the same clock stamps as the encoders: dds is stamped by its sender, "
              "the others by this computer's kernel");
}

const Node& entry_of(Fields& fields, std::string_view key) {
  static const Node kEmpty = Node::map();
  const Node* node = fields.node(key);
  return node ? *node : kEmpty;
}

}  // namespace selfcal
