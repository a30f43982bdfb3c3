// Thermal expansion: every length of the moving links grows by alpha (T - T0),
//   delta p_tip = alpha (T - T0) sum over their frames of (d_k X_k + r_k Z_k),
// the vector from the foot of the first moving frame (the last base frame's origin) to the origin
// of the last one; fixed frames in between belong to the links. With `tool` what it carries grows
// as they do, and the vector ends at the tip; with `base` what carries them does (a gantry's
// columns, a pedestal), and it begins at the world's origin. T lags behind the thermometer, `lag`
// dT/dt = T_measured - T (s; 0: at once); `reference` is T0 (C, default the mean of the record).
// alpha: 1/K.
#include <algorithm>
#include <cmath>

#include "kinematics/effects/shared/warmth.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

/// Of a floor that grows with the robot, over the robot that does alone.
constexpr double kFloor = 0.1;

class ThermalExpansion final : public Effect {
 public:
  explicit ThermalExpansion(const EffectPlan& plan) : warmth_(plan, Warmth::Follows::with_lag) {
    parameters_ = {{"alpha", "1/K", 5e-6, 3e-5, true}};
    plan.mechanics();
    tool_ = plan.fields.flag("tool", false);
    base_ = plan.fields.flag("base", false);
  }

  std::string needs() const override { return "temperatures that change"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const int first = at.mechanics->link_of(0);
    const int last = at.mechanics->link_of(static_cast<int>(at.q.size()) - 1);
    Eigen::Vector3d grown = (tool_ ? at.poses.back() : at.poses[last]).translation();
    if (first > 0 && !base_) grown -= at.poses[first - 1].translation();
    into.tip.col(0).head<3>() = warmth_.above(at) * grown;
  }

 private:
  void describe_shape(Node& node) const override {
    if (tool_) node.set("tool", Node::of(std::string("true")));
    if (base_) node.set("base", Node::of(std::string("true")));
    warmth_.describe(node);
  }

  bool tool_ = false, base_ = false;  ///< grows as well
  Warmth warmth_;
};

}  // namespace

std::unique_ptr<Effect> make_thermal_expansion(const EffectPlan& plan) {
  plan.expect_place("");
  return std::make_unique<ThermalExpansion>(plan);
}

void suppose_thermal_expansion(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole()) return;
  const Statics* statics = rows.robot.statics();
  if (!statics) return to.cannot("", "no chain of links carries the tool: see leg_thermal_growth");
  if (!rows.warms) return to.cannot("", "the rows carry no temperatures that change");
  const Mechanics& mechanics = statics->mechanics();
  const int first = mechanics.link_of(0);
  const int last = mechanics.link_of(static_cast<int>(rows.robot.joints().size()) - 1);
  // What carries a robot is of its machine where its first joint slides (a gantry); else it is the
  // floor, or the way from an instrument.
  const bool gantry = rows.robot.joints().front().quantity == Quantity::length;
  const auto add = [&](bool tool, bool base) {
    const auto suppose = [&](const EffectShape& shape) {
      to.add("", shape);
      if (base && !gantry) to.last().share = kFloor;
    };
    suppose({.tool = tool, .base = base});
    for (const double lag : supposed_lags(rows.context))
      suppose({.lag = lag, .tool = tool, .base = base});
  };
  const auto zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.robot.joints().size()));
  const bool carried =
      first > 0 &&
      statics->link_poses(zero)[static_cast<size_t>(first) - 1].translation().norm() > 0;
  for (const bool base : {false, true})
    for (const bool tool : {false, true})
      if ((!base || carried) && (!tool || last + 1 < static_cast<int>(mechanics.links.size())))
        add(tool, base);
}

}  // namespace selfcal
