// diagnosis.json.
#pragma once

#include <nlohmann/json.hpp>

#include "diagnosis/comparison/comparison.h"
#include "diagnosis/comparison/simulation.h"
#include "diagnosis/findings.h"

namespace selfcal {

nlohmann::ordered_json to_json(const Diagnosis& diagnosis);
nlohmann::ordered_json to_json(const Comparison& comparison);
/// {"why": [sentences], "robot_only", "simulation_only", "both", "geometry": as of a comparison}.
nlohmann::ordered_json to_json(const Differences& differences);

/// The rows to measure next: {"steps": [{"what", "separates", "probability_after", "rows": [{"set",
/// "q", and where they matter "wrench", "dq", "time"}]}]}, as a data set's columns have them.
nlohmann::ordered_json next_json(const Diagnosis& diagnosis, const DataSet& data);

}  // namespace selfcal
