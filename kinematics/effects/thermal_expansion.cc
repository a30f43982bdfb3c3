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

/// The first-order lag of a record that is linear between its samples, begun in balance.
std::vector<double> lagged(const std::vector<double>& t, const std::vector<double>& T, double lag) {
  std::vector<double> out(T);
  for (size_t i = 1; lag > 0 && i < t.size(); ++i) {
    const double dt = t[i] - t[i - 1];
    const double slope = dt > 0 ? (T[i] - T[i - 1]) / dt : 0;
    out[i] = T[i] - slope * lag + (out[i - 1] - T[i - 1] + slope * lag) * std::exp(-dt / lag);
  }
  return out;
}

class ThermalExpansion final : public Effect {
 public:
  explicit ThermalExpansion(const EffectPlan& plan) : warmth_(plan) {
    parameters_ = {{"alpha", "1/K", 5e-6, 3e-5, true}};
    plan.mechanics();
    tool_ = plan.fields.flag("tool", false);
    base_ = plan.fields.flag("base", false);
    lag_ = plan.fields.number("lag", 0.0);
    if (lag_ < 0) plan.fields.fail("lag", "a time of at least 0 s");
    times_ = plan.context.times;
    temperatures_ = lagged(times_, plan.context.temperatures, lag_);
  }

  std::string needs() const override { return "temperatures that change"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const int first = at.mechanics->link_of(0);
    const int last = at.mechanics->link_of(static_cast<int>(at.q.size()) - 1);
    Eigen::Vector3d grown = (tool_ ? at.poses.back() : at.poses[last]).translation();
    if (first > 0 && !base_) grown -= at.poses[first - 1].translation();
    into.tip.col(0).head<3>() = warmth_.above(temperature(at)) * grown;
  }

 private:
  double temperature(const RegressorInput& at) const {
    if (lag_ == 0 || times_.size() < 2 || std::isnan(at.time)) return at.temperature;
    const auto after = std::lower_bound(times_.begin(), times_.end(), at.time);
    if (after == times_.begin()) return temperatures_.front();
    if (after == times_.end()) return temperatures_.back();
    const auto i = static_cast<size_t>(after - times_.begin());
    const double dt = times_[i] - times_[i - 1];
    const double share = dt > 0 ? (at.time - times_[i - 1]) / dt : 1;
    return temperatures_[i - 1] + share * (temperatures_[i] - temperatures_[i - 1]);
  }

  void describe_shape(Node& node) const override {
    node.set("lag", Node::of(lag_));
    if (tool_) node.set("tool", Node::of(std::string("true")));
    if (base_) node.set("base", Node::of(std::string("true")));
    warmth_.describe(node);
  }

  bool tool_ = false, base_ = false;  ///< grows as well
  double lag_ = 0;
  Warmth warmth_;
  std::vector<double> times_, temperatures_;
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
  const double span = rows.context.end - rows.context.begin;
  const Mechanics& mechanics = statics->mechanics();
  const int first = mechanics.link_of(0);
  const int last = mechanics.link_of(static_cast<int>(rows.robot.joints().size()) - 1);
  const auto add = [&](bool tool, bool base) {
    to.add("", {.tool = tool, .base = base});
    for (const double share : {0.125, 0.25, 0.5, 1.0})
      if (span > 0) to.add("", {.lag = share * span, .tool = tool, .base = base});
  };
  for (const bool base : {false, true})
    for (const bool tool : {false, true})
      if ((!base || first > 0) && (!tool || last + 1 < static_cast<int>(mechanics.links.size())))
        add(tool, base);
}

}  // namespace selfcal
