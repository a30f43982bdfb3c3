// Looking for the cause of what calibration leaves: what a cell could touch next to tell
// look-alikes apart, and the corrected model once a cause is named. Pure functions; the analyst
// runs them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/service/config/config.h"
#include "constraints/progress.h"
#include "constraints/solution.h"
#include "diagnosis/findings.h"
#include "io/store/store.h"

namespace selfcal {

/// The newest full session with a result, of this robot and configuration and older than session
/// `before`: what a cause is looked for in.
std::optional<SessionRecord> base_of_cause(Store& store, const std::string& model_hash,
                                           const std::string& config_hash, std::int64_t before);

/// Touches that a cell can make, each with the row that it would give.
struct CellTouches {
  std::vector<PlannedTouch> touches;
  PossibleRows rows;
};

/// Within the limits of the cell: those of `before` once more, and others on the same surfaces in
/// other postures; each also come to by other joints, and slowly. Nothing of locks. `data` has the
/// sets that the rows are of.
CellTouches possible_touches(const Robot& robot, const Config& config,
                             const std::vector<StepRecord>& before, const DataSet& data,
                             unsigned long long seed, const Progress& progress);

/// The robot with what was named, identified anew from all rows.
struct CorrectedModel {
  Solution solution;
  std::string robot_text;
};

/// Nothing where no cause is named that a robot keeps: what has moved in its cell is mended there,
/// and then it is calibrated anew.
std::optional<CorrectedModel> corrected_model(const Robot& active, const DataSet& data,
                                              const Diagnosis& diagnosis, const Progress& progress);

}  // namespace selfcal
