// A stored session as an ordinary data set, so that it can be solved again.
#pragma once

#include <filesystem>
#include <string>

#include "io/result.h"
#include "io/store/store.h"

namespace selfcal {

/// Writes the rows that the session's good touches make into `folder`, which must be new or empty.
/// The robot is that of the session's result with its maker's figures as values, or `robot_text`
/// where there is no result (of an aborted session, of a check); empty `robot_text` is a failure
/// then. Fails as well when the raw rows are no longer kept. Returns the number of rows.
Result<int> export_session(Store& store, std::int64_t session, const std::string& robot_text,
                           const std::filesystem::path& folder);

}  // namespace selfcal
