#include "app/report/drift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/report/format.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostColumns = 3;  // of the table: what fits 80 characters

/// Most that it moved from one calibration to the next; of an only one, from the factory's.
double moved(const Drift& drift) {
  double most = 0;
  const std::size_t first = drift.since_last.size() > 1 ? 1 : 0;
  for (std::size_t i = first; i < drift.since_last.size(); ++i)
    most = std::max(most, std::abs(drift.since_last[i]));
  return most;
}

/// Whether that is more than the last calibration is unsure of.
bool surely(const Drift& drift) { return moved(drift) > drift.sigma.back(); }

ReadableUnit shown_unit(const Drift& drift) {
  double most = drift.sigma.back();
  for (const double each : drift.since_factory) most = std::max(most, std::abs(each));
  return readable_unit(drift.unit, most);
}

}  // namespace

std::vector<Drift> drifts(const std::vector<AcceptedParameters>& calibrations, std::size_t most) {
  if (calibrations.empty()) return {};
  const std::vector<Parameter>& parameters = calibrations.front().robot->parameters();
  std::vector<Drift> all;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    Drift drift;
    drift.name = full_name(parameters[p]);
    drift.unit = parameters[p].unit();
    double before = parameters[p].nominal;
    for (const AcceptedParameters& calibration : calibrations) {
      const Parameter& now = calibration.robot->parameters()[p];
      drift.since_factory.push_back(now.value - now.nominal);
      drift.since_last.push_back(now.value - before);
      const auto sigma = calibration.sigma.find(now.name);
      drift.sigma.push_back(sigma == calibration.sigma.end() ? 0 : sigma->second);
      before = now.value;
    }
    if (moved(drift) > 0) all.push_back(std::move(drift));
  }
  std::ranges::stable_sort(all, std::greater<>(), [](const Drift& drift) {
    return std::pair(surely(drift), moved(drift));
  });
  if (all.size() > most) all.resize(most);
  return all;
}

std::string drift_table(const std::vector<AcceptedParameters>& calibrations,
                        const std::vector<Drift>& drifts) {
  const std::size_t count = calibrations.size();
  const std::size_t first = count > kMostColumns ? count - kMostColumns : 0;
  int width = 23;
  for (const Drift& drift : drifts) width = std::max(width, characters(drift.name) + 1);
  int units = 5;
  for (const Drift& drift : drifts) units = std::max(units, characters(shown_unit(drift).name) + 1);
  std::string text = padded("", width + 2 + units);
  for (std::size_t c = first; c < count; ++c)
    text += printed(
        "%20s", printed("session %lld", static_cast<long long>(calibrations[c].session)).c_str());
  const bool sigmas =
      std::ranges::any_of(drifts, [](const Drift& d) { return d.sigma.back() > 0; });
  if (sigmas) text += printed("%9s", "sigma");
  text += "\n" + padded("", width + 2 + units);
  for (std::size_t c = first; c < count; ++c)
    text += printed("%20s", date_time(calibrations[c].unix_ms).substr(0, 10).c_str());
  for (const Drift& drift : drifts) {
    const ReadableUnit unit = shown_unit(drift);
    text += "\n  " + padded(drift.name, width) + padded(unit.name, units);
    for (std::size_t c = first; c < count; ++c) {
      const std::string change = c > 0 ? printed("(%+.3f)", unit.factor * drift.since_last[c]) : "";
      text += printed("%+10.3f%10s", unit.factor * drift.since_factory[c], change.c_str());
    }
    if (drift.sigma.back() > 0) text += printed("%9.3f", unit.factor * drift.sigma.back());
    text.erase(text.find_last_not_of(' ') + 1);
  }
  return text + "\n";
}

}  // namespace selfcal
