// What a session of a cell would do: its touches, their motion and how well the end position is
// known then.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/service/config/config.h"
#include "constraints/planning/touch_plan.h"
#include "constraints/progress.h"

namespace selfcal {

struct CellPlan {
  TouchPlan plan;
  ExpectedSigma expected;  ///< meaningless where the plan lacks touches
  MotionTime time;

  /// Nothing is lacking, the workspace is reached and the target is met in it.
  bool reaches(const Config& config) const;
};

/// Plans as the service does.
CellPlan plan_cell(const Config& config, const Progress& progress);

/// By set, then the figures; or why there is no plan.
std::string cell_plan_report(const Config& config, const CellPlan& cell);
nlohmann::ordered_json cell_plan_json(const Config& config, const CellPlan& cell);
/// The contacts in their order, as a data set has them before anything is measured; its file.
DataSet cell_plan_data(const Config& config, const CellPlan& cell);
std::string cell_plan_rows(const Config& config, const CellPlan& cell);

}  // namespace selfcal
