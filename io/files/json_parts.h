// What every JSON writer needs of numbers and lists.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace selfcal {

/// The number, or null: JSON knows neither NaN nor infinity.
inline nlohmann::ordered_json finite(double number) {
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json(nullptr);
}

/// `convert` of each element, in order.
template <class List, class Convert>
nlohmann::ordered_json array_of(const List& list, Convert convert) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const auto& each : list) array.push_back(convert(each));
  return array;
}

}  // namespace selfcal
