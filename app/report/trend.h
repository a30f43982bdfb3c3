// A straight line through a figure over time, and when it leaves its limits at that rate.
#pragma once

#include <optional>
#include <vector>

namespace selfcal {

/// value(t) = at + rate (t - middle); t in the unit of the times given.
struct Trend {
  double middle = 0, at = 0, rate = 0;
  double rate_sigma =
      0;  ///< from the sigmas, or from the scatter about the line where that is more
  double value(double t) const { return at + rate * (t - middle); }
};

/// The weighted least-squares line through at least three points of which two differ in time;
/// nothing otherwise. Where a sigma is not positive, all points weigh the same and their scatter
/// alone counts.
std::optional<Trend> trend(const std::vector<double>& times, const std::vector<double>& values,
                           const std::vector<double>& sigmas);

/// The time after `now` at which the line leaves [least, most]; nothing where its rate is within
/// two sigmas of none, or where it is outside at `now`.
std::optional<double> leaves_at(const Trend& trend, double now, double least, double most);

}  // namespace selfcal
