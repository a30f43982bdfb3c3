// The result of an identification as JSON, for result.json and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "constraints/estimation/controller_sigma.h"
#include "constraints/solution.h"

namespace selfcal {

/// Keys in the order of the file format. What is not known (no sigma, no check rows, a number that
/// is not finite) is null. Numbers read back bit by bit.
nlohmann::ordered_json to_json(const Solution& solution, const std::string& robot_name,
                               const std::string& model_hash);
/// {parameters, left, sigma}: a part of "uncertainty".
nlohmann::ordered_json to_json(const ControllerSigma& controller);

}  // namespace selfcal
