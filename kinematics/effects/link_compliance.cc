// Compliance of the link that a joint's frame carries: a beam from the frame's origin O to the next
// one's E that everything beyond E bends and twists. With M the moment of the load about E, in the
// frame's axes,
//   rotation of the end  omega = (bend_x M_x, bend_y M_y, twist M_z)
//   shift of the end     s = omega x (E - O) / 2
// as of a cantilever under an end moment (Kamali et al. leave links rigid). rad/(N m).
#include "kinematics/effect.h"
#include "kinematics/robot.h"

namespace selfcal {
namespace {

class LinkCompliance final : public Effect {
 public:
  LinkCompliance(const Mechanics& mechanics, int joint) : link_(mechanics.link_of(joint)) {
    parameters_ = {{"bend_x", "rad/(N m)", 1e-8, 2e-5},
                   {"bend_y", "rad/(N m)", 1e-8, 2e-5},
                   {"twist", "rad/(N m)", 1e-8, 2e-5}};
  }

  std::string needs() const override { return "a load whose moment on the link changes"; }

  void influence(const Circumstances& at, Influence& into) const override {
    const int next = std::min(link_ + 1, static_cast<int>(at.poses.size()) - 1);
    const Eigen::Vector3d O = at.poses[link_].translation(), E = at.poses[next].translation();
    const Eigen::Vector3d tip = at.poses.back().translation();
    const Eigen::Vector3d moment = load_about(*at.mechanics, at.poses, at.wrench, next, E).moment;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d a = at.poses[link_].linear().col(axis);
      const Eigen::Vector3d omega = a * a.dot(moment);
      into.tip.col(axis).head<3>() = omega.cross(E - O) / 2 + omega.cross(tip - E);
      into.tip.col(axis).tail<3>() = omega;
    }
  }

 private:
  int link_;
};

}  // namespace

std::unique_ptr<Effect> make_link_compliance(const EffectPlan& plan) {
  return std::make_unique<LinkCompliance>(plan.robot.mechanics(), plan.joint());
}

}  // namespace selfcal
