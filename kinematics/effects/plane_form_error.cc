// Form error of a touched surface: it stands out of its plane by
//   h = a u^2 + b u v + c v^2
// u, v along two tangents from its middle (SurfaceFrame). The contact compares with the plane after
// h is taken off along the normal. a, b, c: 1/m.
#include "kinematics/effects/shared/surface_frame.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class PlaneFormError final : public Effect {
 public:
  PlaneFormError(const EffectPlan& plan, int set) : set_(set), frame_(surface_frame(plan, set)) {
    for (const char* name : {"a", "b", "c"}) parameters_.push_back({name, "1/m", 1e-4, 2e-3});
  }

  bool of_machine() const override { return false; }
  std::string needs() const override { return "touches spread over the surface"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (at.set != set_ || set_ < 0) return;
    const Eigen::Vector3d from = at.poses.back().translation() - frame_.centre;
    const double u = frame_.u.dot(from), v = frame_.v.dot(from);
    const double share[] = {u * u, u * v, v * v};
    for (int i = 0; i < 3; ++i) into.tip.col(i).head<3>() = -share[i] * frame_.normal;
  }

 private:
  void describe_shape(Node& node) const override { frame_.describe(node); }

  int set_;
  SurfaceFrame frame_;
};

}  // namespace

std::unique_ptr<Effect> make_plane_form_error(const EffectPlan& plan) {
  return std::make_unique<PlaneFormError>(plan, plan.set());
}

void suppose_plane_form_error(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.set < 0 || !rows.shows(place.set)) return;
  if (rows.context.sets[static_cast<size_t>(place.set)].touch == TouchedSurface::plane)
    to.add(place.name);
}

}  // namespace selfcal
