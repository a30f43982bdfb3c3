// Tool shift: the probe, the reflector or the tool is moved, remounted or exchanged at `moment`
// (s): from then on its tip is shifted and the tool turned about it, as the last frame's axes have
// it,
//   shift = R (x y z),   turn = R (rx ry rz)   for t >= moment, R the last frame's axes.
// m, rad.
#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class ToolShift final : public Effect {
 public:
  explicit ToolShift(const EffectPlan& plan) : moment_(plan.fields.number("moment")) {
    for (const char* name : {"x", "y", "z"}) parameters_.push_back({name, "m", 1e-5, 2e-3});
    for (const char* name : {"rx", "ry", "rz"}) parameters_.push_back({name, "rad", 1e-4, 5e-2});
  }

  std::string needs() const override { return "rows with times before and after it"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (!(at.time >= moment_)) return;
    const Eigen::Matrix3d R = at.poses.back().linear();
    into.tip.topLeftCorner<3, 3>() = R;
    into.tip.bottomRightCorner<3, 3>() = R;
  }

 private:
  void describe_shape(Node& node) const override { node.set("moment", Node::of(moment_)); }

  double moment_;
};

}  // namespace

std::unique_ptr<Effect> make_tool_shift(const EffectPlan& plan) {
  plan.expect_place("probe");
  return std::make_unique<ToolShift>(plan);
}

void suppose_tool_shift(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole()) return;
  const std::vector<double> moments = rows.moments(-1);
  for (const double moment : moments) to.add("probe", {.moment = moment});
  if (moments.empty()) to.cannot("probe", "the rows carry no time");
}

}  // namespace selfcal
