// What goes with the temperature: by how much it is above T0, the `reference` of an entry (C).
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "kinematics/effect.h"

namespace selfcal {

class Warmth {
 public:
  explicit Warmth(const EffectPlan& plan) : reference_(plan.reference()) {}

  /// K; 0 where `celsius` is not known.
  double above(double celsius) const {
    return std::isnan(celsius) ? 0 : celsius - reference_.value_or(kRoomTemperature);
  }
  void describe(Node& node) const {
    if (reference_) node.set("reference", Node::of(*reference_));
  }

 private:
  std::optional<double> reference_;
};

/// Of an entry with `by: temperature`; nothing without `by`, and a problem where it is another.
inline std::optional<Warmth> warmth_by(const EffectPlan& plan) {
  const std::string by = plan.fields.text("by", "");
  if (by == "temperature") return Warmth(plan);
  if (!by.empty()) plan.fields.fail("by", "temperature");
  return std::nullopt;
}

}  // namespace selfcal
