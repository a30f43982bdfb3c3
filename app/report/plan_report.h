// A plan of configurations for a person and for a program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "constraints/planning/configuration_plan.h"

namespace selfcal {

/// `target`: end-position accuracy wanted (m, 1 sigma).
std::string plan_report(const Robot& robot, const PlanRequest& request,
                        const ConfigurationPlan& plan, double target);
nlohmann::ordered_json plan_json(const Robot& robot, const PlanRequest& request,
                                 const ConfigurationPlan& plan, double target);

}  // namespace selfcal
