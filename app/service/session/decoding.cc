#include "app/service/session/decoding.h"

#include <cmath>
#include <optional>
#include <utility>

#include "io/files/file.h"
#include "io/files/yaml.h"

namespace selfcal {

int set_index(const Decoding& decoding, const std::string& name) {
  for (std::size_t s = 0; s < decoding.sets.size(); ++s)
    if (decoding.sets[s].name == name) return static_cast<int>(s);
  return 0;
}

std::string decoding_text(const Config& config, const std::vector<EncoderScale>& scales) {
  Node node = config.description;
  node.set("delay", Node::of(config.touch.delay));
  if (config.causes.payload) node.set("payload", Node::of(*config.causes.payload));
  Node list = Node::list();
  for (const EncoderScale& scale : scales) {
    Node each = Node::map();
    each.set("step", Node::of(scale.step));
    each.set("zero", Node::of(std::to_string(scale.zero)));
    list.items.push_back(std::move(each));
  }
  node.set("encoders", std::move(list));
  Node outward = Node::map();
  for (const TouchTarget& target : config.targets)
    outward.set(config.sets[target.set].name, Node::of(Eigen::VectorXd(target.outward)));
  node.set("outward", std::move(outward));
  return write_yaml(node);
}

std::string config_hash(const Config& config, const std::vector<EncoderScale>& scales) {
  return sha256_hex(decoding_text(config, scales) + write_yaml(config.transports) +
                    config.robot->text().identity());
}

Result<Decoding> read_decoding(const std::string& text) {
  const Result<Node> node = parse_yaml(text, "session");
  if (!node) return tl::unexpected(node.error());
  Result<std::vector<Set>> sets = sets_of(text);
  if (!sets) return tl::unexpected(sets.error());
  Decoding decoding;
  decoding.sets = std::move(*sets);
  Problems problems;
  Fields fields(*node, "session", problems);
  decoding.target = fields.number("target");
  if (const Node* workspace = fields.node("workspace"))
    decoding.workspace = read_workspace(*workspace, problems);
  decoding.delay = fields.number("delay");
  decoding.payload = fields.number("payload", 0.0);
  if (const Node* list = fields.node("encoders"))
    for (const Node& each : list->items) {
      Fields scale(each, "encoder", problems);
      decoding.scales.push_back({scale.number("step"), std::llround(scale.number("zero"))});
    }
  const Node* outward = fields.node("outward");
  for (const Set& set : decoding.sets) {
    std::optional<Eigen::VectorXd> way;
    if (outward) way = Fields(*outward, "outward", problems).numbers(set.name, 3);
    decoding.outward.push_back(way ? Eigen::Vector3d(*way) : Eigen::Vector3d::UnitZ());
  }
  if (problems.any()) return bad_input(problems);
  return decoding;
}

Reading reading_of(const TouchRecord& touch, const Decoding& decoding) {
  return reading_between(touch.before, touch.after, touch.edge - nanoseconds(decoding.delay),
                         decoding.scales);
}

}  // namespace selfcal
