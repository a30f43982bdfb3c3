// Transmission error: periodic in the joint's angle,
//   delta q = sum over waves k of sinK sin(k q) + cosK cos(k q)
// with k waves a turn (`waves`: 1 is eccentricity, 2 ovality or a flexspline, others meshing).
// q: the joint's reading (rad; of a prismatic joint 2 pi q / m). sinK, cosK: rad (m).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "kinematics/effect.h"
#include "kinematics/robot.h"
#include "kinematics/suppositions.h"

namespace selfcal {
namespace {

/// Turns a metre of the screws and belts that slides have, finer than those asked one by one:
/// pitches of 15, 12.5, 12, 10, 8, 6, 5.08, 5, 4, 3, 2.5 and 2 mm.
constexpr double kScrews[] = {66.67,  80,  83.33, 100,    125, 166.67,
                              196.85, 200, 250,   333.33, 400, 500};

/// Waves a turn of strain wave gears of 80, 100, 120 and 160 to 1, and one more: once and twice a
/// turn of their generator.
constexpr double kGenerators[] = {80,  81,  100, 101, 120, 121, 160, 161,
                                  162, 200, 202, 240, 242, 320, 322};

class TransmissionError final : public Effect {
 public:
  TransmissionError(const EffectPlan& plan, int joint) : joint_(joint) {
    const bool turns = plan.robot.joints()[joint].quantity == Quantity::angle;
    scale_ = turns ? 1 : 2 * std::numbers::pi;
    waves_ = plan.fields.positives("waves", "waves a turn");
    if (waves_.empty()) waves_ = {1};
    if (!all_differ(waves_)) plan.fields.fail("waves", "numbers that differ");
    for (const double k : waves_)
      for (const char* function : {"sin", "cos"})
        parameters_.push_back({function + format_number(k), turns ? "rad" : "m", 2.4e-5, 4.4e-4});
  }

  std::string needs() const override { return "angles spread over the joint's turn"; }

  void regressor(const RegressorInput& at, Regressor& into) const override {
    for (size_t i = 0; i < waves_.size(); ++i) {
      const double angle = waves_[i] * scale_ * at.q[joint_];
      into.joints(joint_, 2 * static_cast<Eigen::Index>(i)) = std::sin(angle);
      into.joints(joint_, 2 * static_cast<Eigen::Index>(i) + 1) = std::cos(angle);
    }
  }

 private:
  void describe_shape(Node& node) const override { node.set("waves", Node::of(waves_)); }

  int joint_;
  double scale_ = 1;
  std::vector<double> waves_;
};

}  // namespace

std::unique_ptr<Effect> make_transmission_error(const EffectPlan& plan) {
  return std::make_unique<TransmissionError>(plan, plan.joint());
}

void suppose_transmission_error(const Supposed& rows, const EffectPlace& place, Suppositions& to) {
  if (place.joint < 0) return;
  for (int k = 1; k <= rows.most_waves; ++k) to.add(place.name, {.waves = {1.0 * k}});
  const bool turns = rows.robot.joints()[place.joint].quantity == Quantity::angle;
  for (const double k : turns ? std::span<const double>(kGenerators) : kScrews)
    if (k > rows.most_waves) to.add(place.name, {.waves = {k}});
  if (place.joint < static_cast<int>(rows.hinted_waves.size()))
    for (const double k : rows.hinted_waves[static_cast<std::size_t>(place.joint)])
      if (!turns || std::ranges::find(kGenerators, k) == std::end(kGenerators)) {
        to.add(place.name, {.waves = {k}});
        to.last().share = rows.hinted_share;
      }
  to.add(place.name);
  to.last().together = 2;
  to.add(place.name);
  to.last().together = rows.profile;
  to.last().profile = true;
}

}  // namespace selfcal
