// What the service tells, as JSON for programs: one object a message, `topic` first. SI units.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/messages.h"

namespace selfcal {

nlohmann::ordered_json to_json(const StatusMessage& status);
nlohmann::ordered_json to_json(const ProgressMessage& progress);
/// The result's own JSON stands under `result` as an object, null when there is none.
nlohmann::ordered_json to_json(const ResultMessage& result);
nlohmann::ordered_json to_json(const std::string& robot, std::int64_t unix_ms,
                               const std::vector<HealthMessage>& health);

/// "ok", "warn", "error" or "stale".
std::string_view to_string(Health level);

/// One line of text; bytes that are no UTF-8 are replaced.
std::string line_of(const nlohmann::ordered_json& json);

}  // namespace selfcal
