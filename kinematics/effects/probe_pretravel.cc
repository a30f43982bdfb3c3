// Pretravel of the probe: the stylus gives way before the trigger fires,
//   pretravel = p0 + sin(phi) (p1 + p3 cos(3 psi) + q3 sin(3 psi))
// phi the angle between the surface's normal and the stylus (z of the last frame), psi the azimuth
// of the normal about it, counted from x. The tip that fired lies that deep in the surface, so the
// contact was at the tip plus the pretravel along the outward normal. How the three feet stand to x
// is as the probe was screwed in: p3 and q3 are what they do along and beside it. On a ball there
// is no p0: it would be another radius, and where the radius is given the scale of the whole robot.
// p0, p1, p3, q3: m.
#include <algorithm>
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/effects/shared/touched_surfaces.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class ProbePretravel final : public Effect {
 public:
  explicit ProbePretravel(const MeasurementContext& context) : surfaces_(context) {
    parameters_ = {{"p0", "m", 1e-6, 1e-4, true},
                   {"p1", "m", 1e-6, 1e-4, true},
                   {"p3", "m", 1e-6, 1e-4},
                   {"q3", "m", 1e-6, 1e-4}};
  }

  bool of_machine() const override { return false; }
  std::string needs() const override { return "touches at different angles to the stylus"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const Eigen::Vector3d outward = surfaces_.normal(at);
    if (!outward.allFinite()) return;
    const Eigen::Vector3d n = at.poses.back().linear().transpose() * outward;
    const double sine = std::hypot(n.x(), n.y()), psi = std::atan2(n.y(), n.x());
    const double all_round = surfaces_.on_ball(at) ? 0 : 1;
    const double share[] = {all_round, sine, sine * std::cos(3 * psi), sine * std::sin(3 * psi)};
    for (int i = 0; i < 4; ++i) into.tip.col(i).head<3>() = share[i] * outward;
  }

 private:
  TouchedSurfaces surfaces_;
};

}  // namespace

std::unique_ptr<Effect> make_probe_pretravel(const EffectPlan& plan) {
  plan.expect_place("probe");
  return std::make_unique<ProbePretravel>(plan.context);
}

void suppose_probe_pretravel(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole() || !rows.context.touched()) return;
  const bool planes = std::ranges::any_of(
      rows.context.sets, [](const MeasuredSet& set) { return set.touch == TouchedSurface::plane; });
  if (planes || rows.normals)
    to.add("probe");
  else
    to.cannot("probe", "the rows carry no normals");
}

}  // namespace selfcal
