// What every JSON writer needs of numbers and lists, and what a reader of others' JSON does.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace selfcal {

/// Entries stay in the order in which they are put there.
using Json = nlohmann::ordered_json;

/// The number, or null: JSON knows neither NaN nor infinity.
inline Json finite(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

/// `convert` of each element, in order.
template <class List, class Convert>
Json array_of(const List& list, Convert convert) {
  Json array = Json::array();
  for (const auto& each : list) array.push_back(convert(each));
  return array;
}

/// What `text` says that somebody else wrote; discarded where it is no JSON, or deeper than ours
/// ever is: it is written out again by a function that calls itself for each level.
inline Json foreign_json(const std::string& text) {
  constexpr int kDeepest = 64;
  bool too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  Json json = Json::parse(text, keep, false);
  return too_deep ? Json(Json::value_t::discarded) : json;
}

}  // namespace selfcal
