// Past sessions and calibrations as the store has them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/report/drift.h"
#include "io/result.h"
#include "io/store/store.h"

namespace selfcal {

/// A session with its result, if it has one.
struct Past {
  SessionRecord session;
  std::optional<ResultRecord> result;
};

/// Of a damaged session nothing is known but its number (Store::sessions).
bool is_damaged(const Past& past);

/// The newest sessions, newest first.
Result<std::vector<Past>> read_past(Store& store, int newest);
/// Accepted parameters, oldest first; those of another machine than the newest's are left out.
Result<std::vector<AcceptedParameters>> read_calibrations(Store& store);

/// "finished", "unfinished", "aborted", "damaged", "damaged result".
std::string state_of(const Past& past);

/// A session as `history --json` has it.
nlohmann::ordered_json record_of(const Past& past);

}  // namespace selfcal
