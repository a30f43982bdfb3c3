// A stored session as an ordinary data set, so that it can be solved again.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "constraints/methods/data_set.h"
#include "io/result.h"
#include "io/store/store.h"

namespace selfcal {

/// A stored session, with the robot that it measured as its maker gives it.
struct SessionRows {
  SessionRecord record;
  std::string robot_text;  ///< the robot's file
  std::shared_ptr<const Robot> robot;
  DataSet data;
};

/// The rows that the session's good touches make; of a look for a cause after those of the full
/// session that it is looked for in. The robot is that of the session's result with
/// its maker's figures as values, or `robot_text` where there is no result (of an aborted session,
/// of a check); empty `robot_text` is a failure then. Fails as well when the raw rows are no longer
/// kept.
Result<SessionRows> session_rows(Store& store, std::int64_t session, const std::string& robot_text);

/// Writes these rows into `folder`, which must be new or empty, and returns their number.
Result<int> export_session(Store& store, std::int64_t session, const std::string& robot_text,
                           const std::filesystem::path& folder);

}  // namespace selfcal
