// Where a further surface or socket would help most, for a person and for a program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "constraints/planning/next_place.h"

namespace selfcal {

/// The best few places.
std::string next_place_report(const NextRequest& request, const NextPlaces& next);
nlohmann::ordered_json next_json(const NextPlaces& next);

}  // namespace selfcal
