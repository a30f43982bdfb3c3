// slope = S_tv / S_tt about the weighted mean, var(slope) = 1 / S_tt, times chi2 / (n - 2) where
// that is above 1.
#include "app/report/trend.h"

#include <algorithm>
#include <cmath>

namespace selfcal {

std::optional<Trend> trend(const std::vector<double>& times, const std::vector<double>& values,
                           const std::vector<double>& sigmas) {
  const std::size_t n = times.size();
  if (n < 3) return std::nullopt;
  const bool weighted = std::ranges::all_of(sigmas, [](double sigma) { return sigma > 0; });
  const auto weight = [&](std::size_t i) { return weighted ? 1 / (sigmas[i] * sigmas[i]) : 1; };
  double w = 0, t = 0, v = 0;
  for (std::size_t i = 0; i < n; ++i) {
    w += weight(i);
    t += weight(i) * times[i];
    v += weight(i) * values[i];
  }
  Trend line{t / w, v / w};
  double tt = 0, tv = 0, chi2 = 0;
  for (std::size_t i = 0; i < n; ++i) {
    tt += weight(i) * std::pow(times[i] - line.middle, 2);
    tv += weight(i) * (times[i] - line.middle) * (values[i] - line.at);
  }
  if (tt <= 0) return std::nullopt;
  line.rate = tv / tt;
  for (std::size_t i = 0; i < n; ++i)
    chi2 += weight(i) * std::pow(values[i] - line.value(times[i]), 2);
  const double scatter = chi2 / static_cast<double>(n - 2);
  line.rate_sigma = std::sqrt((weighted ? std::max(1.0, scatter) : scatter) / tt);
  return line;
}

std::optional<double> leaves_at(const Trend& trend, double now, double least, double most) {
  const double value = trend.value(now);
  if (std::abs(trend.rate) <= 2 * trend.rate_sigma || value < least || value > most)
    return std::nullopt;
  return now + ((trend.rate > 0 ? most : least) - value) / trend.rate;
}

}  // namespace selfcal
