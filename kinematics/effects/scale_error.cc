// Scale error of a measuring device: the lengths that it measures are too long by a share
//   s   or, with `by: temperature`,   k (T - T0),   T0 the reference (C; the rows' mean)
// so that what it measures stands off the robot's model as if the tip, seen from the device's
// `origin` o, were that much farther out: shift = s (p - o). o is where the set's rows have the
// device, the world's origin of one that measures in the world's frame. s: 1, k: 1/K.
#include "kinematics/effects/shared/warmth.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

/// Of an instrument that follows the temperature, over one that is off: most allow for it.
constexpr double kAllowedFor = 0.1;

class ScaleError final : public Effect {
 public:
  ScaleError(const EffectPlan& plan, int set)
      : set_(set), warmth_(warmth_by(plan, Warmth::Follows::with_lag)) {
    if (const auto written = plan.fields.numbers("origin", 3))
      origin_ = *written;
    else if (set >= 0 && !plan.context.sets[set].without_rows)
      origin_ = plan.context.sets[set].device;
    if (warmth_)
      parameters_ = {{"k", "1/K", 1e-7, 2e-5}};
    else
      parameters_ = {{"s", "1", 1e-6, 5e-5}};
  }

  bool of_machine() const override { return false; }
  std::string needs() const override {
    return warmth_ ? "temperatures that change" : "lengths that are known otherwise";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (at.set != set_ || set_ < 0) return;
    const double share = warmth_ ? warmth_->above(at) : 1;
    into.tip.col(0).head<3>() =
        share * (at.poses.back().translation() - origin_.value_or(Eigen::Vector3d::Zero()));
  }

 private:
  void describe_shape(Node& node) const override {
    if (origin_) node.set("origin", Node::of(Eigen::VectorXd(*origin_)));
    if (!warmth_) return;
    node.set("by", Node::of(std::string("temperature")));
    warmth_->describe(node);
  }

  int set_;
  std::optional<Eigen::Vector3d> origin_;  ///< m, world
  std::optional<Warmth> warmth_;           ///< by: temperature
};

}  // namespace

std::unique_ptr<Effect> make_scale_error(const EffectPlan& plan) {
  return std::make_unique<ScaleError>(plan, plan.set());
}

void suppose_scale_error(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  // An instrument's unit may be off, or grow with the air's temperature.
  if (place.set < 0 || !rows.shows(place.set)) return;
  if (!rows.context.sets[static_cast<size_t>(place.set)].lengths) return;
  to.add(place.name);
  if (!rows.warms) return;
  const std::vector<double> lags = supposed_lags(rows.context);
  const auto suppose = [&](const EffectShape& shape) {
    to.add(place.name, shape);
    to.last().share = kAllowedFor / (1.0 + static_cast<double>(lags.size()));
  };
  suppose({.by = "temperature"});
  for (const double lag : lags) suppose({.lag = lag, .by = "temperature"});
}

}  // namespace selfcal
