// Compliance of the link that a joint's frame carries: a beam from the frame's origin O to the next
// one's E that everything beyond E bends and twists. At a share t of its length, with M(t) the
// moment of that load about O + t (E - O), in the frame's axes, it turns by
//   d omega = (bend_x M_x, bend_y M_y, twist M_z) dt
// as a cantilever under a force and a moment at its end does (Kamali et al. leave links rigid). M
// is linear in t and what it moves the tip quadratic: two points of Gauss give the whole. rad/(N
// m).
#include <numbers>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

constexpr double kGauss = 0.5 * std::numbers::inv_sqrt3;  ///< from the middle
/// Of a bending link over other causes. A joint's spring looks much like it, and links are quite
/// stiffer than joints, so that many leave them rigid (Dumas et al., Robotica 2011, as above).
constexpr double kOverOthers = 0.3;

class LinkCompliance final : public Effect {
 public:
  LinkCompliance(const Mechanics& mechanics, int joint) : link_(mechanics.link_of(joint)) {
    parameters_ = {{"bend_x", "rad/(N m)", 1e-8, 2e-5, true},
                   {"bend_y", "rad/(N m)", 1e-8, 2e-5, true},
                   {"twist", "rad/(N m)", 1e-8, 2e-5, true}};
  }

  std::string needs() const override { return "a load whose moment on the link changes"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    const int next = std::min(link_ + 1, static_cast<int>(at.poses.size()) - 1);
    const Eigen::Vector3d O = at.poses[link_].translation(), E = at.poses[next].translation();
    const Eigen::Vector3d tip = at.poses.back().translation();
    const Load load = load_about(*at.mechanics, at.poses, at.wrench, next, E);
    for (const double t : {0.5 - kGauss, 0.5 + kGauss}) {
      const Eigen::Vector3d here = O + t * (E - O);
      const Eigen::Vector3d moment = load.moment + (E - here).cross(load.force);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d a = at.poses[link_].linear().col(axis);
        const Eigen::Vector3d omega = a * a.dot(moment) / 2;
        into.tip.col(axis).head<3>() += omega.cross(tip - here);
        into.tip.col(axis).tail<3>() += omega;
      }
    }
  }

 private:
  int link_;
};

}  // namespace

std::unique_ptr<Effect> make_link_compliance(const EffectPlan& plan) {
  const Mechanics* mechanics = plan.mechanics();
  if (!mechanics) return nullptr;
  return std::make_unique<LinkCompliance>(*mechanics, plan.joint());
}

void suppose_link_compliance(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  const Statics* statics = rows.robot.statics();
  if (!statics) return to.cannot(place.name, std::string(kNoStatics));
  const Mechanics& mechanics = statics->mechanics();
  if (!(mechanics.gravity.norm() > 0) && !rows.context.loads) return;
  if (mechanics.masses_known() || rows.context.loads)
    to.add(place.name);
  else
    return to.cannot(place.name, "the robot file gives no masses and the rows no loads");
  to.last().odds = kOverOthers;
}

}  // namespace selfcal
