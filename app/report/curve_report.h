// How many touches or configurations are enough, for a person and for a program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace selfcal {

/// The least count of `what` that knows the end position to `target` (m), and the curve, sigma (m)
/// by count from 0, at counts of which each is half as many again; every line begins with `indent`.
std::string curve_report(const std::vector<double>& curve, double target, const std::string& what,
                         const std::string& indent);
/// As `enough`, null where none is, and `curve`.
void put_curve(const std::vector<double>& curve, double target, nlohmann::ordered_json& json);

}  // namespace selfcal
