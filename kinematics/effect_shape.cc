#include "kinematics/effect_shape.h"

namespace selfcal {

Node entry_of(const ShapedEffect& effect) {
  Node entry = Node::map();
  entry.set("effect", Node::of(effect.effect));
  if (!effect.at.empty()) entry.set("at", Node::of(effect.at));
  const EffectShape& shape = effect.shape;
  const auto set = [&](const char* key, const std::optional<double>& value) {
    if (value) entry.set(key, Node::of(*value));
  };
  set("moment", shape.moment);
  set("settle", shape.settle);
  set("lag", shape.lag);
  set("mass", shape.mass);
  if (!shape.waves.empty()) entry.set("waves", Node::of(shape.waves));
  if (!shape.half_waves.empty()) entry.set("half_waves", Node::of(shape.half_waves));
  if (shape.lumps) entry.set("lumps", Node::of(std::string("true")));
  if (shape.tool) entry.set("tool", Node::of(std::string("true")));
  if (shape.base) entry.set("base", Node::of(std::string("true")));
  if (!shape.by.empty()) entry.set("by", Node::of(shape.by));
  if (!shape.from.empty()) entry.set("from", Node::of(shape.from));
  return entry;
}

}  // namespace selfcal
