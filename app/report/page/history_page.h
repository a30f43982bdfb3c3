// The page of a robot's history: what drifts, how fast, and when a limit will be left at this rate.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/report/page/page.h"
#include "app/report/past.h"

namespace selfcal {

struct HistoryFindings {
  std::string robot;                             ///< name, or where its state is
  std::vector<Past> sessions;                    ///< newest first
  std::vector<AcceptedParameters> calibrations;  ///< oldest first
  std::vector<EventRecord> events;               ///< newest first
  double target = 0;                             ///< m, wanted of the end position; 0 where unknown
  std::int64_t unix_ms = 0;                      ///< when the page is made
};

/// The page's object: `sessions` as `history --json` has them, `drifts` with values less the
/// maker's figure, sigma and rate (SI, a day), `residual` the same of the quick checks, `events`.
nlohmann::ordered_json history_data(const HistoryFindings& findings);

}  // namespace selfcal
