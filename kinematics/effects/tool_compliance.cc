// Compliance of the tool or its mount: all that follows the last moving frame turns about that
// frame's origin O by
//   omega = (bend_x M_x, bend_y M_y, twist M_z),   rad/(N m)
// M the moment about O, in that frame's axes, of the tool's weight and of the wrench at its tip (a
// rigid tool on a spring; a link that bends along its length is link_compliance). Where it gives
// way elsewhere (`by: tool`: a stylus that bends, a spring askew), the tip moves by
//   S f,   S = (xx xy xz; xy yy yz; xz yz 0),   m/N
// f that weight and the wrench's force, in the tip's axes; z is the tool's own, along which it is
// stiff: what gives way to its weight alike in all directions moves the tip as the base would.
// Where the tool's frames have no mass, `mass` (kg, 1 where nothing is said) hangs at the tip.
#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

/// Of the frames behind `last`; nothing where none of them has a mass.
bool has_weight(const Mechanics& mechanics, int last) {
  for (size_t k = static_cast<size_t>(last) + 1; k < mechanics.links.size(); ++k)
    if (mechanics.links[k].mass > 0.0) return true;
  return false;
}

class ToolCompliance final : public Effect {
 public:
  ToolCompliance(const EffectPlan& plan, const Mechanics& mechanics)
      : last_(mechanics.link_of(static_cast<int>(plan.robot.joints().size()) - 1)) {
    const std::string by = plan.fields.text("by", "mount");
    if (by != "mount" && by != "tool") plan.fields.fail("by", "mount or tool");
    bends_ = by == "tool";
    if (bends_)
      parameters_ = {{"xx", "m/N", 1e-8, 1e-5, true},
                     {"yy", "m/N", 1e-8, 1e-5, true},
                     {"xy", "m/N", 1e-8, 1e-5},
                     {"xz", "m/N", 1e-8, 1e-5},
                     {"yz", "m/N", 1e-8, 1e-5}};
    else
      parameters_ = {{"bend_x", "rad/(N m)", 1e-6, 2e-4, true},
                     {"bend_y", "rad/(N m)", 1e-6, 2e-4, true},
                     {"twist", "rad/(N m)", 1e-6, 2e-4, true}};
    weightless_ = !has_weight(mechanics, last_);
    if (weightless_) mass_ = plan.fields.number("mass", 1.0);
    if (mass_ < 0) plan.fields.fail("mass", "at least 0 kg");
  }

  std::string needs() const override {
    return "a tool whose tip stands off the last joint, and a load on it that changes";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (bends_) return bending(at, into);
    const Eigen::Isometry3d& mount = at.poses[static_cast<size_t>(last_)];
    const Eigen::Vector3d arm = at.poses.back().translation() - mount.translation();
    const Load load =
        load_about(*at.mechanics, at.poses, at.wrench, last_ + 1, mount.translation());
    const Eigen::Vector3d moment = load.moment + arm.cross(mass_ * at.mechanics->gravity);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d a = mount.linear().col(axis);
      const Eigen::Vector3d omega = a * a.dot(moment);
      into.tip.col(axis).head<3>() = omega.cross(arm);
      into.tip.col(axis).tail<3>() = omega;
    }
  }

 private:
  void bending(const RegressorInput& at, Regressor& into) const {
    const Eigen::Isometry3d& tip = at.poses.back();
    const Load load = load_about(*at.mechanics, at.poses, at.wrench, last_ + 1, tip.translation());
    const Eigen::Matrix3d& R = tip.linear();
    const Eigen::Vector3d f = R.transpose() * (load.force + mass_ * at.mechanics->gravity);
    const auto moves = [&](int a, int b) -> Eigen::Vector3d {
      return R.col(a) * f[b] + R.col(b) * f[a];
    };
    into.tip.col(0).head<3>() = R.col(0) * f[0];
    into.tip.col(1).head<3>() = R.col(1) * f[1];
    into.tip.col(2).head<3>() = moves(0, 1);
    into.tip.col(3).head<3>() = moves(0, 2);
    into.tip.col(4).head<3>() = moves(1, 2);
  }

  void describe_shape(Node& node) const override {
    if (bends_) node.set("by", Node::of(std::string("tool")));
    if (weightless_) node.set("mass", Node::of(mass_));
  }

  int last_;
  bool bends_ = false;       ///< by: tool
  bool weightless_ = false;  ///< its frames have no mass
  double mass_ = 0;          ///< kg, at the tip
};

}  // namespace

std::unique_ptr<Effect> make_tool_compliance(const EffectPlan& plan) {
  plan.expect_place("probe");
  const Mechanics* mechanics = plan.mechanics();
  if (!mechanics) return nullptr;
  return std::make_unique<ToolCompliance>(plan, *mechanics);
}

void suppose_tool_compliance(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole()) return;
  const Statics* statics = rows.robot.statics();
  if (!statics) return to.cannot("probe", std::string(kNoStatics));
  if (statics->mechanics().gravity.norm() > 0 || rows.context.loads)
    for (const char* by : {"", "tool"}) to.add("probe", {.by = by});
  else
    to.cannot("probe", "without gravity the rows carry no loads");
}

}  // namespace selfcal
