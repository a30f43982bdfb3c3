// Drift of the base frame: a slow motion of the robot against everything that it measures,
//   shift = s(t) (x y z),   turn = s(t) (rx ry rz) about the world's origin
// with s from 0 at `begin` to 1 at `end`, by default of the rows: a straight line, or, with a time
// constant `settle` (s), (1 - exp(-(t - begin) / settle)) / (1 - exp(-(end - begin) / settle));
// before and after it is as at `begin` and at `end`.
// x y z: m, rx ry rz: rad, over the whole data set. Or it wanders: with K half waves over the rows
// (`half_waves`: [1, 2, 3]),
//   shift = sum over K of (1 - cos(K pi u)) / 2 (xK yK zK),   turn likewise by (rxK ryK rzK)
// u the straight line above; the larger K, the smaller each is expected to be. Or it is moved at a
// `moment` (s), the robot's base or the instrument: s is 0 before and 1 from then on.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

class BaseDrift final : public Effect {
 public:
  explicit BaseDrift(const EffectPlan& plan) {
    read_span(plan);
    settle_ = plan.fields.number("settle", 0.0);
    if (settle_ < 0) plan.fields.fail("settle", "a time of at least 0 s");
    half_waves_ = plan.fields.positives("half_waves", "half waves over the rows");
    if (!all_differ(half_waves_)) plan.fields.fail("half_waves", "numbers that differ");
    moment_ = plan.fields.optional_number("moment");
    if (settle_ > 0 && !half_waves_.empty())
      plan.fields.fail("settle", "a drift that settles or one that wanders");
    if (moment_ &&
        (settle_ > 0 || !half_waves_.empty() || plan.fields.has("begin") || plan.fields.has("end")))
      plan.fields.fail("moment", "a base that drifts or one that is moved at once");
    if (moment_) add_motion("", 2e-3, 2e-3);
    if (!moment_ && half_waves_.empty()) add_motion("", 2e-4, 2e-4);
    for (const double k : half_waves_) add_motion(format_number(k), 2e-4 / k, 2e-4 / k);
  }

  std::string needs() const override {
    return moment_ ? "rows with times before and after it"
                   : "rows with times, spread over the drift";
  }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    if (moment_) {
      if (at.time >= *moment_) move(at, 1, 0, into);
      return;
    }
    if (std::isnan(at.time) || !drifts()) return;
    const double time = std::clamp(at.time, *begin_, *end_);
    if (half_waves_.empty()) return move(at, share(time), 0, into);
    for (size_t i = 0; i < half_waves_.size(); ++i) {
      const double angle = half_waves_[i] * std::numbers::pi * line(time);
      move(at, (1 - std::cos(angle)) / 2, 6 * static_cast<Eigen::Index>(i), into);
    }
  }

 private:
  /// What the entry leaves open is the rows', where that makes a span.
  void read_span(const EffectPlan& plan) {
    begin_ = plan.fields.optional_number("begin");
    end_ = plan.fields.optional_number("end");
    if (begin_ && end_ && !drifts()) plan.fields.fail("end", "a time after `begin`");
    if (plan.context.end <= plan.context.begin) return;
    const double begin = begin_.value_or(plan.context.begin);
    const double end = end_.value_or(plan.context.end);
    if (end <= begin) return;
    begin_ = begin;
    end_ = end;
  }

  bool drifts() const { return begin_ && end_ && *end_ > *begin_; }

  /// The least that is usual is a 40th of the most shift and a 20th of the most turn.
  void add_motion(const std::string& suffix, double shift, double turn) {
    for (const char* name : {"x", "y", "z"})
      parameters_.push_back({name + suffix, "m", shift / 40, shift});
    for (const char* name : {"rx", "ry", "rz"})
      parameters_.push_back({name + suffix, "rad", turn / 20, turn});
  }

  /// The columns from `first` on: `s` of a shift along and a turn about each axis.
  static void move(const RegressorInput& at, double s, Eigen::Index first, Regressor& into) {
    const Eigen::Vector3d tip = at.poses.back().translation();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = s * Eigen::Vector3d::Unit(axis);
      into.tip.col(first + axis).head<3>() = unit;
      into.tip.col(first + 3 + axis).head<3>() = unit.cross(tip);
      into.tip.col(first + 3 + axis).tail<3>() = unit;
    }
  }

  double line(double time) const { return (time - *begin_) / (*end_ - *begin_); }

  double share(double time) const {
    if (settle_ == 0) return line(time);
    return std::expm1(-(time - *begin_) / settle_) / std::expm1(-(*end_ - *begin_) / settle_);
  }

  void describe_shape(Node& node) const override {
    if (moment_) return void(node.set("moment", Node::of(*moment_)));
    if (begin_) node.set("begin", Node::of(*begin_));
    if (end_) node.set("end", Node::of(*end_));
    if (settle_ > 0) node.set("settle", Node::of(settle_));
    if (!half_waves_.empty()) node.set("half_waves", Node::of(half_waves_));
  }

  std::optional<double> begin_, end_, moment_;  ///< s
  double settle_ = 0;
  std::vector<double> half_waves_;
};

}  // namespace

std::unique_ptr<Effect> make_base_drift(const EffectPlan& plan) {
  plan.expect_place("base");
  return std::make_unique<BaseDrift>(plan);
}

void suppose_base_drift(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (!place.whole()) return;
  const double span = rows.context.end - rows.context.begin;
  if (!(span > 0)) return to.cannot("base", "the rows carry no time");
  std::vector<EffectShape> shapes = {{}};
  for (const double share : {0.15, 0.5}) shapes.push_back({.settle = share * span});
  for (const int most : {2, 4}) {
    std::vector<double> half_waves(static_cast<size_t>(most));
    std::iota(half_waves.begin(), half_waves.end(), 1.0);
    shapes.push_back({.half_waves = std::move(half_waves)});
  }
  const auto add = [&](EffectShape shape, double share) {
    to.add("base", std::move(shape));
    to.last().share = share;
    to.last().drifts = true;
  };
  const auto drifting = static_cast<double>(shapes.size());
  for (EffectShape& each : shapes) add(std::move(each), 1);
  // As probable, all moments together, as all drifts.
  const std::vector<double> moments = rows.moments(-1);
  for (const double moment : moments)
    add({.moment = moment}, drifting / static_cast<double>(moments.size()));
}

}  // namespace selfcal
