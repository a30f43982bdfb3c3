// Drift of the base frame: a slow motion of the robot against everything that it measures,
//   shift = s(t) (x y z),   turn = s(t) (rx ry rz) about the world's origin
// with s from 0 at `begin` to 1 at `end` of the rows: a straight line, or, with a time constant
// `settle` (s), (1 - exp(-(t - begin) / settle)) / (1 - exp(-(end - begin) / settle)).
// x y z: m, rx ry rz: rad, over the whole data set.
#include <cmath>

#include "kinematics/effect.h"
#include "kinematics/robot.h"

namespace selfcal {
namespace {

class BaseDrift final : public Effect {
 public:
  explicit BaseDrift(const EffectPlan& plan) {
    for (const char* name : {"x", "y", "z"}) parameters_.push_back({name, "m", 5e-6, 2e-4});
    for (const char* name : {"rx", "ry", "rz"}) parameters_.push_back({name, "rad", 1e-5, 2e-4});
    begin_ = plan.fields.number("begin", plan.site.begin);
    end_ = plan.fields.number("end", plan.site.end);
    settle_ = plan.fields.number("settle", 0.0);
    if (settle_ < 0) plan.fields.fail("settle", "a time of at least 0 s");
  }

  std::string needs() const override { return "rows with times, spread over the drift"; }

  void influence(const Circumstances& at, Influence& into) const override {
    const double s = share(at.time);
    const Eigen::Vector3d tip = at.poses.back().translation();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = s * Eigen::Vector3d::Unit(axis);
      into.tip.col(axis).head<3>() = unit;
      into.tip.col(3 + axis).head<3>() = unit.cross(tip);
      into.tip.col(3 + axis).tail<3>() = unit;
    }
  }

 private:
  double share(double time) const {
    if (std::isnan(time) || end_ <= begin_) return 0;
    if (settle_ == 0) return (time - begin_) / (end_ - begin_);
    return std::expm1(-(time - begin_) / settle_) / std::expm1(-(end_ - begin_) / settle_);
  }

  void describe_shape(Node& node) const override {
    node.set("begin", Node::of(begin_));
    node.set("end", Node::of(end_));
    if (settle_ > 0) node.set("settle", Node::of(settle_));
  }

  double begin_ = 0, end_ = 0, settle_ = 0;
};

}  // namespace

std::unique_ptr<Effect> make_base_drift(const EffectPlan& plan) {
  plan.expect_place("base");
  return std::make_unique<BaseDrift>(plan);
}

}  // namespace selfcal
