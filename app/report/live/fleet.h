// A line for each robot of the domain, the one that needs a person most first.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/report/live/monitor_view.h"

namespace selfcal {

/// How much a robot needs a person.
enum class Concern : std::uint8_t { none, warning, waits, error, silent };

Concern concern_of(const Watched& watched);
std::string_view to_string(Concern concern);

/// {"robot", "concern", "why", "state", "session", "done", "planned", "health", "candidate",
/// "active", "result": {"unix_ms", "kind", "answer", "decision"}, "off", "next_due_ms", "silent"}.
/// `off` (m) is how far the active parameters missed the touches of the last session: rms on rows
/// kept aside, of a quick check on all its touches; null when that is not known.
nlohmann::ordered_json fleet_line(const Watched& watched);

/// The lines, worst first; among equals by the robot's name.
nlohmann::ordered_json fleet_json(std::vector<nlohmann::ordered_json> lines);

/// The same for a terminal: how many need a person, a table, and why; at most `rows` lines of at
/// most `columns` characters, of which the last says how many robots are not shown. `fleet` as
/// fleet_json gives it; times as seen at `now_ms`.
std::vector<Line> fleet_picture(const nlohmann::ordered_json& fleet, std::int64_t now_ms,
                                int columns, int rows);

}  // namespace selfcal
