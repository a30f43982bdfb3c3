// diagnosis.json.
#pragma once

#include <nlohmann/json.hpp>

#include "diagnosis/compare.h"
#include "diagnosis/diagnosis.h"

namespace selfcal {

nlohmann::ordered_json to_json(const Diagnosis& diagnosis);
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace selfcal
