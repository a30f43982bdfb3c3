// Coupling: a joint is dragged along by another, `from`: delta q_j = kappa q_i. kappa: 1 between
// joints of one kind, else m/rad or rad/m.
#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class JointCoupling final : public Effect {
 public:
  JointCoupling(const EffectPlan& plan, int joint) : joint_(joint) {
    const std::string from = plan.fields.text("from");
    const std::vector<Joint>& joints = plan.robot.joints();
    from_ = find_joint(plan.robot, from);
    if (from_ < 0 || from_ == joint) plan.fields.fail("from", "another joint of the robot");
    from_name_ = from;
    const Quantity driven = joints[joint].quantity;
    const bool alike = from_ < 0 || joints[from_].quantity == driven;
    const char* mixed = driven == Quantity::length ? "m/rad" : "rad/m";
    parameters_ = {{"kappa_" + from, alike ? "1" : mixed, 1e-5, 1e-3}};
  }

  std::string needs() const override { return "the two joints to move independently"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    into.joints(joint_, 0) = at.q[from_];
  }

 private:
  void describe_shape(Node& node) const override { node.set("from", Node::of(from_name_)); }

  int joint_, from_ = -1;
  std::string from_name_;
};

}  // namespace

std::unique_ptr<Effect> make_joint_coupling(const EffectPlan& plan) {
  return std::make_unique<JointCoupling>(plan, plan.joint());
}

void suppose_joint_coupling(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  for (const Joint& other : rows.robot.joints())
    if (other.name != place.name) to.add(place.name, {.from = other.name});
}

}  // namespace selfcal
