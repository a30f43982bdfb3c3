// The truth behind a simulated data set, as a file of its own.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/data_set_maker.h"

namespace selfcal {

/// True parameters and what of them is wrong in the nominal robot (by name, SI), own values under
/// the names of result.json, noise, false rows (from 1) and what the model lacks.
nlohmann::ordered_json truth_json(const Scenario& scenario, const Robot& robot,
                                  const Simulated& made);

}  // namespace selfcal
