#include "app/web/changes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "app/report/drift.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

using ChangeJson = nlohmann::ordered_json;

struct ParameterChange {
  std::string name, unit;
  double change = 0;
  ChangeJson sigma;
};

ChangeJson changes_json(const std::vector<ParameterChange>& changes) {
  auto rows = ChangeJson::array();
  for (std::size_t i = 0; i < std::min(changes.size(), kChangesShown); ++i)
    rows.push_back({{"name", changes[i].name},
                    {"unit", changes[i].unit},
                    {"change", finite(changes[i].change)},
                    {"sigma", changes[i].sigma}});
  return {{"rows", std::move(rows)}, {"count", changes.size()}};
}

/// What `parameter` of a result.json has under `key`, if it is a number.
double number_at(const ChangeJson& parameter, const char* key) {
  const auto found = parameter.find(key);
  return found != parameter.end() && found->is_number() ? found->get<double>()
                                                        : std::numeric_limits<double>::quiet_NaN();
}

std::string text_at(const ChangeJson& parameter, const char* key) {
  const auto found = parameter.find(key);
  return found != parameter.end() && found->is_string() ? found->get<std::string>() : "";
}

/// As full_name has it.
std::string name_at(const ChangeJson& parameter) {
  const std::string name = text_at(parameter, "name"), frame = text_at(parameter, "frame");
  const std::string kind = name.substr(0, name.find_first_of("0123456789"));
  return frame.empty() || kind.size() == name.size() ? name : name + " " + frame + "." + kind;
}

/// The entries of a result.json under "parameters".
ChangeJson parameters_of(const std::string& result) {
  const ChangeJson json = foreign_json(result);
  const bool whole = json.is_object() && json.contains("parameters");
  return whole && json["parameters"].is_array() ? json["parameters"] : ChangeJson();
}

}  // namespace

ChangeJson changes_between(const std::shared_ptr<const Robot>& from,
                           const std::shared_ptr<const Robot>& to, const std::string& result) {
  if (from->text().identity() != to->text().identity() ||
      from->parameters().size() != to->parameters().size())
    return nullptr;
  std::map<std::string, ChangeJson> sigmas;
  for (const ChangeJson& each : parameters_of(result))
    sigmas[text_at(each, "name")] = finite(number_at(each, "sigma"));
  std::map<std::string, std::string> short_names;
  for (const Parameter& each : to->parameters()) short_names[full_name(each)] = each.name;
  std::vector<ParameterChange> changes;
  for (const Drift& each : drifts({{0, 0, from}, {0, 0, to}}, to->parameters().size()))
    changes.push_back({each.name, each.unit, each.since_last[1], sigmas[short_names[each.name]]});
  return changes_json(changes);
}

ChangeJson changes_of_result(const std::string& result) {
  const ChangeJson parameters = parameters_of(result);
  if (parameters.is_null()) return nullptr;
  std::vector<ParameterChange> changes;
  for (const ChangeJson& each : parameters) {
    const double change = number_at(each, "value") - number_at(each, "nominal");
    if (std::isfinite(change) && change != 0)
      changes.push_back(
          {name_at(each), text_at(each, "unit"), change, finite(number_at(each, "sigma"))});
  }
  std::ranges::stable_sort(changes, std::greater<>(),
                           [](const ParameterChange& each) { return std::abs(each.change); });
  return changes_json(changes);
}

ChangeJson sets_of_result(const ChangeJson& result) {
  const ChangeJson::json_pointer from("/residual/check/by_set");
  if (!result.is_object() || !result.contains(from) || !result[from].is_array()) return nullptr;
  auto sets = ChangeJson::array();
  for (const ChangeJson& each : result[from])
    sets.push_back({{"name", text_at(each, "name")},
                    {"rows", finite(number_at(each, "rows"))},
                    {"before", finite(number_at(each, "rms_before"))},
                    {"after", finite(number_at(each, "rms_after"))}});
  return sets;
}

}  // namespace selfcal
