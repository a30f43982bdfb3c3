// Shift of a fixture: from `moment` (s) on the touched surface stands elsewhere,
//   h = shift + tilt_u v - tilt_v u
// further out along its outward normal, turned about its tangents u, v (SurfaceFrame) by tilt_u and
// tilt_v. The contact compares with the plane after h is taken off along the normal. m, rad.
#include "kinematics/effects/shared/surface_frame.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class FixtureShift final : public Effect {
 public:
  FixtureShift(const EffectPlan& plan, int set) : set_(set), frame_(surface_frame(plan, set)) {
    parameters_ = {
        {"shift", "m", 5e-6, 3e-4}, {"tilt_u", "rad", 5e-6, 1e-3}, {"tilt_v", "rad", 5e-6, 1e-3}};
    moment_ = plan.fields.number("moment");
  }

  bool of_machine() const override { return false; }
  std::string needs() const override { return "touches with times before and after it"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (at.set != set_ || set_ < 0 || !(at.time >= moment_)) return;
    const Eigen::Vector3d from = at.poses.back().translation() - frame_.centre;
    const double share[] = {1, frame_.v.dot(from), -frame_.u.dot(from)};
    for (int i = 0; i < 3; ++i) into.tip.col(i).head<3>() = -share[i] * frame_.normal;
  }

 private:
  void describe_shape(Node& node) const override {
    node.set("moment", Node::of(moment_));
    frame_.describe(node);
  }

  int set_;
  SurfaceFrame frame_;
  double moment_ = 0;
};

}  // namespace

std::unique_ptr<Effect> make_fixture_shift(const EffectPlan& plan) {
  return std::make_unique<FixtureShift>(plan, plan.set());
}

void suppose_fixture_shift(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.set < 0 || !rows.shows(place.set) || !rows.normals) return;
  if (!rows.context.sets[static_cast<size_t>(place.set)].touch) return;
  for (const double moment : rows.moments(place.set)) to.add(place.name, {.moment = moment});
}

}  // namespace selfcal
