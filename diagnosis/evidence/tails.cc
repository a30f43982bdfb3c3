#include "diagnosis/evidence/tails.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr double kStep = 0.25;     ///< sigma
constexpr double kFromBelow = 6;   ///< sigma, where the knots begin
constexpr double kKnotsFrom = 10;  ///< that they serve; below, the exact value is asked

}  // namespace

NoiseTail::NoiseTail(double freedom) : freedom_(freedom) {
  if (freedom < kKnotsFrom) return;
  const double sigma = std::sqrt(2 * freedom);
  step_ = kStep * sigma / freedom;
  const double first = std::max(freedom - kFromBelow * sigma, freedom / 10);
  first_ = std::log(first);
  const double surely = std::log(freedom + 10 * sigma + 50);
  for (double log_x = first_; log_x < surely + step_; log_x += step_) {
    const double x = std::exp(log_x), log = log_chi_square_below(x, freedom);
    const double log_density = freedom / 2 * std::log(x / 2) - x / 2 - std::lgamma(freedom / 2);
    knots_.push_back({log, step_ * std::exp(log_density - log)});
  }
}

double NoiseTail::log_below(double value) const {
  const double at = (std::log(value) - first_) / step_;
  if (knots_.empty() || at < 0) return log_chi_square_below(value, freedom_);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= knots_.size()) return 0;
  const double t = at - static_cast<double>(i);
  const Knot &a = knots_[i], &b = knots_[i + 1];
  const double rise = b.value - a.value;
  return a.value + t * (a.slope + t * (3 * rise - 2 * a.slope - b.slope +
                                       t * (a.slope + b.slope - 2 * rise)));
}

double student_below_nearly(double value, double freedom) {
  if (freedom < kKnotsFrom) return student_below(value, freedom);
  const double a = freedom - 0.5, b = 48 * a * a;
  const double y = a * std::log1p(value * value / freedom);
  const double z =
      ((((-0.4 * y - 3.3) * y - 24) * y - 85.5) / (0.8 * y * y + 100 + b) + y + 3) / b + 1;
  return std::erfc(-std::copysign(z * std::sqrt(y), value) / std::numbers::sqrt2) / 2;
}

}  // namespace selfcal
