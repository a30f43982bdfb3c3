#include "app/report/curve_report.h"

#include <algorithm>

#include "app/report/format.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

constexpr int kCurveColumns = 9;  // of the curve in words

/// The least count whose sigma is within the target; negative where none is.
int enough(const std::vector<double>& curve, double target) {
  for (std::size_t n = 0; n < curve.size(); ++n)
    if (curve[n] <= target) return static_cast<int>(n);
  return -1;
}

/// Counts at which the curve is told: doubling, and the last.
std::vector<std::size_t> told_counts(std::size_t last) {
  std::vector<std::size_t> counts{last};
  while (counts.back() > 1 && counts.size() < kCurveColumns)
    counts.push_back((counts.back() * 2 + 1) / 3);
  std::reverse(counts.begin(), counts.end());
  return counts;
}

std::string enough_report(const std::vector<double>& curve, double target,
                          const std::string& what) {
  const int count = enough(curve, target);
  if (count == 0) return "the maker's figures alone know it to the target of " + mm(target) + " mm";
  return count < 0 ? "the target of " + mm(target) + " mm is not reached"
                   : std::to_string(count) + " " + what + " know it to the target of " +
                         mm(target) + " mm";
}

}  // namespace

std::string curve_report(const std::vector<double>& curve, double target, const std::string& what,
                         const std::string& indent) {
  std::string counts, sigmas;
  for (const std::size_t n : told_counts(curve.size() - 1)) {
    counts += printed(" %8zu", n);
    sigmas += printed(" %8s", mm(curve[n]).c_str());
  }
  return indent + "how many: " + enough_report(curve, target, what) + "\n" + indent +
         "  count     " + counts + "\n" + indent + "  sigma, mm " + sigmas + "\n";
}

void put_curve(const std::vector<double>& curve, double target, nlohmann::ordered_json& json) {
  const int count = enough(curve, target);
  json["enough"] = count < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(count);
  json["curve"] = array_of(curve, finite);
}

}  // namespace selfcal
