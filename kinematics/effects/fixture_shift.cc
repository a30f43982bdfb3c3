// Shift of a fixture: from `moment` (s) on what is touched stands elsewhere. A plane
//   h = shift + tilt_u v - tilt_v u
// further out along its outward normal, turned about its tangents u, v (SurfaceFrame) by tilt_u and
// tilt_v (m, rad): the contact compares with the plane after h is taken off along the normal. A
// ball by (x, y, z) (m, world), which is taken off as it is.
#include <algorithm>
#include <initializer_list>

#include "kinematics/effects/shared/surface_frame.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

constexpr double kLeast = 5e-6, kMost = 3e-4;  // m, of a usual shift

class FixtureShift : public Effect {
 public:
  FixtureShift(const EffectPlan& plan, int set)
      : set_(set), moment_(plan.fields.number("moment")) {}

  bool of_machine() const override { return false; }
  std::string needs() const override { return "touches with times before and after it"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (at.set == set_ && set_ >= 0 && at.time >= moment_)
      shift(at.poses.back().translation(), into.tip);
  }

 protected:
  /// What a touch at `tip` finds it off by, to each parameter.
  virtual void shift(const Eigen::Vector3d& tip, Eigen::MatrixXd& into) const = 0;
  void describe_shape(Node& node) const override { node.set("moment", Node::of(moment_)); }

 private:
  int set_;
  double moment_ = 0;
};

class PlaneShift final : public FixtureShift {
 public:
  PlaneShift(const EffectPlan& plan, int set)
      : FixtureShift(plan, set), frame_(surface_frame(plan, set)) {
    parameters_ = {{"shift", "m", kLeast, kMost},
                   {"tilt_u", "rad", 5e-6, 1e-3},
                   {"tilt_v", "rad", 5e-6, 1e-3}};
  }

 private:
  void shift(const Eigen::Vector3d& tip, Eigen::MatrixXd& into) const override {
    const Eigen::Vector3d from = tip - frame_.centre;
    const double share[] = {1, frame_.v.dot(from), -frame_.u.dot(from)};
    for (int i = 0; i < 3; ++i) into.col(i).head<3>() = -share[i] * frame_.normal;
  }
  void describe_shape(Node& node) const override {
    FixtureShift::describe_shape(node);
    frame_.describe(node);
  }

  SurfaceFrame frame_;
};

class BallShift final : public FixtureShift {
 public:
  BallShift(const EffectPlan& plan, int set) : FixtureShift(plan, set) {
    for (const char* name : {"x", "y", "z"}) parameters_.push_back({name, "m", kLeast, kMost});
  }

 private:
  void shift(const Eigen::Vector3d&, Eigen::MatrixXd& into) const override {
    into.topRows<3>() = -Eigen::Matrix3d::Identity();
  }
};

/// What the entry says it is, by its figures; without any, what the rows touch.
bool is_ball(const EffectPlan& plan, int set) {
  const auto has_any = [&](std::initializer_list<const char*> keys) {
    return std::ranges::any_of(keys, [&](const char* key) { return plan.fields.has(key); });
  };
  if (has_any({"x", "y", "z"})) return true;
  if (has_any({"shift", "tilt_u", "tilt_v", "normal", "center"}) || set < 0) return false;
  return plan.context.sets[static_cast<size_t>(set)].touch == TouchedSurface::curved;
}

}  // namespace

std::unique_ptr<Effect> make_fixture_shift(const EffectPlan& plan) {
  const int set = plan.set();
  if (is_ball(plan, set)) return std::make_unique<BallShift>(plan, set);
  return std::make_unique<PlaneShift>(plan, set);
}

void suppose_fixture_shift(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.set < 0 || !rows.shows(place.set)) return;
  if (rows.context.sets[static_cast<size_t>(place.set)].touch == TouchedSurface::none) return;
  for (const double moment : rows.moments(place.set)) to.add(place.name, {.moment = moment});
}

}  // namespace selfcal
