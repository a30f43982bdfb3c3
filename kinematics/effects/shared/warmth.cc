#include "kinematics/effects/shared/warmth.h"

#include <algorithm>
#include <cmath>

#include "kinematics/robot.h"

namespace selfcal {
namespace {

/// The first-order lag of a record that is linear between its samples, begun in balance.
std::vector<double> lagged(const std::vector<double>& t, const std::vector<double>& T, double lag) {
  std::vector<double> out(T);
  for (size_t i = 1; lag > 0 && i < t.size(); ++i) {
    const double dt = t[i] - t[i - 1];
    const double slope = dt > 0 ? (T[i] - T[i - 1]) / dt : 0;
    out[i] = T[i] - slope * lag + (out[i - 1] - T[i - 1] + slope * lag) * std::exp(-dt / lag);
  }
  return out;
}

}  // namespace

Warmth::Warmth(const EffectPlan& plan, Follows how) : reference_(plan.reference()) {
  if (how == Follows::at_once) return;
  lag_ = plan.fields.number("lag", 0.0);
  if (*lag_ < 0) plan.fields.fail("lag", "a time of at least 0 s");
  times_ = plan.context.times;
  temperatures_ = lagged(times_, plan.context.temperatures, *lag_);
}

double Warmth::above(const RegressorInput& at) const {
  const double celsius = temperature(at);
  return std::isnan(celsius) ? 0 : celsius - reference_.value_or(kRoomTemperature);
}

double Warmth::temperature(const RegressorInput& at) const {
  if (lag_.value_or(0) == 0 || times_.size() < 2 || std::isnan(at.time)) return at.temperature;
  const auto after = std::lower_bound(times_.begin(), times_.end(), at.time);
  if (after == times_.begin()) return temperatures_.front();
  if (after == times_.end()) return temperatures_.back();
  const auto i = static_cast<size_t>(after - times_.begin());
  const double dt = times_[i] - times_[i - 1];
  const double share = dt > 0 ? (at.time - times_[i - 1]) / dt : 1;
  return temperatures_[i - 1] + share * (temperatures_[i] - temperatures_[i - 1]);
}

void Warmth::describe(Node& node) const {
  if (lag_) node.set("lag", Node::of(*lag_));
  if (reference_) node.set("reference", Node::of(*reference_));
}

std::optional<Warmth> warmth_by(const EffectPlan& plan, Warmth::Follows how) {
  const std::string by = plan.fields.text("by", "");
  if (by == "temperature") return Warmth(plan, how);
  if (!by.empty()) plan.fields.fail("by", "temperature");
  return std::nullopt;
}

std::vector<double> supposed_lags(const MeasurementContext& context) {
  std::vector<double> lags;
  const double span = context.end - context.begin;
  for (const double share : {0.125, 0.25, 0.5, 1.0})
    if (span > 0) lags.push_back(share * span);
  return lags;
}

}  // namespace selfcal
