#include "diagnosis/comparison/simulation.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/search/causes.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// The parameters of one of the cause's places; all of a cause without. What was found twice of one
/// parameter adds up.
std::vector<NamedValue> parameters_at(const CauseResult& cause, const std::string& place) {
  std::vector<NamedValue> list;
  for (const NamedValue& each : cause.parameters) {
    if (!place.empty() && !each.name.starts_with(place + ".")) continue;
    const auto same = std::ranges::find(list, each.name, &NamedValue::name);
    if (same == list.end()) {
      list.push_back(each);
      continue;
    }
    same->value += each.value;
    same->sigma = std::hypot(same->sigma, each.sigma);
  }
  return list;
}

std::vector<SideBySide> side_by_side(const ShownCause& robot, const ShownCause& simulation) {
  std::vector<SideBySide> list;
  for (const NamedValue& a : robot.parameters)
    for (const NamedValue& b : simulation.parameters)
      if (a.name == b.name)
        list.push_back({a, b, std::abs(a.value - b.value) / std::hypot(a.sigma, b.sigma)});
  return list;
}

/// What both show, taken out of the two lists: the same effect at the same place, in a shape that
/// has a parameter in common.
std::vector<SharedCause> take_shared(std::vector<ShownCause>& robot,
                                     std::vector<ShownCause>& simulation) {
  std::vector<SharedCause> both;
  std::erase_if(robot, [&](const ShownCause& each) {
    const auto other = std::ranges::find_if(simulation, [&](const ShownCause& cause) {
      return cause.effect == each.effect && cause.where == each.where &&
             (each.parameters.empty() || !side_by_side(each, cause).empty());
    });
    if (other == simulation.end()) return false;
    both.push_back({each.effect, each.where, side_by_side(each, *other)});
    simulation.erase(other);
    return true;
  });
  return both;
}

std::string cause_in_words(const std::string& effect, const std::string& where) {
  if (effect == kUnknown) return "structure that no known effect explains";
  std::string text = effect + (where.empty() ? "" : " at " + where);
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string list_of(const char* opening, const std::vector<ShownCause>& causes) {
  std::string text;
  for (const ShownCause& each : causes)
    text += (text.empty() ? opening : ", ") + cause_in_words(each.effect, each.where);
  return text;
}

std::string apart_in_words(const SharedCause& cause) {
  std::string text;
  for (const SideBySide& each : cause.parameters) {
    if (each.sigmas < kDiagnosis.comparison.apart) continue;
    text += (text.empty() ? "" : ", ") + each.robot.name + " is " +
            in_readable_unit(each.robot.value, each.robot.unit) + " in the robot and " +
            in_readable_unit(each.simulation.value, each.robot.unit) + " in the simulation";
  }
  return text.empty() ? "" : cause_in_words(cause.effect, cause.where) + " is in both, but " + text;
}

std::string geometry_in_words(const Comparison& geometry) {
  std::string text;
  for (const Change& each : geometry.changes) {
    if (each.probability <= kDiagnosis.comparison.shown) continue;
    const bool plain = each.effect == "geometry_differs";
    text += (text.empty() ? "the geometry differs: " : ", ") +
            (plain ? each.where : cause_in_words(each.effect, each.where));
    if (each.values.size() != 1) continue;
    const NamedValue& by = each.values[0];
    const ReadableUnit unit = readable_unit(by.unit, std::max(std::abs(by.value), by.sigma));
    text += " by " + plain_figure(unit.factor * by.value) + " ± " +
            plain_figure(unit.factor * by.sigma, 2) + " " + unit.name;
  }
  return text;
}

std::vector<std::string> sentences(const Differences& of) {
  std::vector<std::string> list;
  const auto add = [&](std::string text) {
    if (!text.empty()) list.push_back(std::move(text));
  };
  add(list_of("the robot has, and its simulation lacks: ", of.robot_only));
  add(list_of("the simulation has, and the robot does not show: ", of.simulation_only));
  for (const SharedCause& each : of.both) add(apart_in_words(each));
  const std::string geometry = geometry_in_words(of.geometry);
  const bool one_sided = !of.robot_only.empty() || !of.simulation_only.empty();
  add(geometry.empty() || !one_sided
          ? geometry
          : geometry + " (what such an effect does to a zero or a length is among this)");
  if (geometry.empty() && !one_sided && of.geometry.none <= kDiagnosis.comparison.unsure)
    add("the geometry differs, but not in one known thing alone");
  if (list.empty())
    list.push_back("these rows show no difference between the robot and its simulation");
  return list;
}

}  // namespace

std::vector<ShownCause> shown_causes(const Diagnosis& diagnosis, const DiagnosisOptions& options) {
  std::vector<ShownCause> list;
  const CauseResult& verdict = diagnosis.verdict;
  if (verdict.effect == kNone) return list;
  if (verdict.effect == kUnknown) list.push_back({kUnknown, "", verdict.probability, {}, {}});
  if (diagnosis.p_value > options.name_below_p) return list;
  for (const CauseResult& each : diagnosis.candidates) {
    if (!names_effect(each.effect) ||
        (each.probability <= kDiagnosis.comparison.shown && each.effect != verdict.effect))
      continue;
    std::vector<std::string> places = each.where;
    if (places.empty()) places.emplace_back();
    for (const std::string& place : places)
      list.push_back(
          {each.effect, place, each.probability, parameters_at(each, place), each.confounded_with});
  }
  return list;
}

Differences differences(const Diagnosis& robot, const Diagnosis& simulation, Comparison geometry,
                        const DiagnosisOptions& options) {
  Differences of;
  of.geometry = std::move(geometry);
  of.robot_only = shown_causes(robot, options);
  of.simulation_only = shown_causes(simulation, options);
  of.both = take_shared(of.robot_only, of.simulation_only);
  of.sentences = sentences(of);
  return of;
}

}  // namespace selfcal
