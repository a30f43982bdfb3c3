// Textbook methods on the same equations as the diagnosis, for its trials to be compared with.
//   stepwise    forward selection by partial F tests (Bonferroni over the candidates, 5 %)
//   bic         forward selection by the Bayesian information criterion
//   compliance  always the second joint's compliance
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/data_set.h"
#include "diagnosis/trials/trials.h"
#include "kinematics/robot.h"

namespace selfcal {

using Baseline = TrialAnswer (*)(const std::shared_ptr<const Robot>&, const DataSet&);

std::vector<std::string> baseline_names();
/// Nothing for a name that baseline_names() lacks.
std::optional<Baseline> find_baseline(std::string_view name);

}  // namespace selfcal
